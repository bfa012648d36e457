//! Claim: the tables of kernels in the README and in the crate's documentation give the same times.

const README: &str = include_str!("../README.md");
const CRATE: &str = include_str!("../src/lib.rs");

/// The times in the table of kernels, each after its pair and the last part of the kernel's name.
fn times(text: &str) -> Vec<[&str; 3]> {
    let lines = text.lines().map(|line| line.trim_start_matches("//!").trim());
    let rows = lines.skip_while(|line| !line.starts_with("| pair |"));
    let mut table = rows
        .map_while(|line| line.strip_prefix('|'))
        .map(|row| row.split('|').map(str::trim).collect::<Vec<_>>());
    let header = table.next().expect("a table of kernels");
    let [kernel, ns] =
        ["kernel", "ns"].map(|name| header.iter().position(|&cell| cell == name).expect(name));
    let mut pair = "";
    let mut times = Vec::new();
    for row in table.skip(1) {
        if !row[0].is_empty() {
            pair = row[0];
        }
        let path = row[kernel].split('`').nth(1).expect("a name in code");
        if !row[ns].is_empty() {
            times.push([pair, path.rsplit("::").next().unwrap_or(path), row[ns]]);
        }
    }
    times
}

#[test]
fn both_tables_give_the_same_times() {
    let times_of_readme = times(README);
    assert!(
        times_of_readme
            .iter()
            .any(|&[pair, kernel, _]| [pair, kernel] == ["ray, triangle", "exact"])
    );
    assert_eq!(times_of_readme, times(CRATE));
}

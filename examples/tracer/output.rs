//! A file of results: whole, or not there.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// A file that can be written, as far as one can tell beforehand.
#[derive(Debug)]
pub(crate) struct Output {
    /// As the user named it.
    file: PathBuf,
    /// What to replace: the file, or what it is a link to.
    target: PathBuf,
}

impl Output {
    /// Makes sure that `file` can be written before hours are spent on its contents.
    pub(crate) fn new(file: &Path) -> Result<Self, Failure> {
        let blame = |error: io::Error| Failure::new(file, error);
        let mut target = file.to_owned();
        if let Ok(existing) = fs::metadata(file) {
            if !existing.is_file() {
                return Err(Failure::new(file, "not a regular file"));
            }
            if existing.permissions().readonly() {
                return Err(Failure::new(file, "read-only"));
            }
            target = fs::canonicalize(file).map_err(blame)?;
        }
        if target.file_name().is_none() {
            return Err(Failure::new(file, "not the name of a file"));
        }
        let output = Self { file: file.to_owned(), target };
        Temporary::create(&output.target).map_err(blame)?;
        Ok(output)
    }

    /// Writes the contents beside the file, then puts them in its place.
    pub(crate) fn write(
        &self,
        contents: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        self.try_write(contents).map_err(|error| Failure::new(&self.file, error))
    }

    fn try_write(&self, contents: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
        let temporary = Temporary::create(&self.target)?;
        let mut writer = BufWriter::new(&temporary.file);
        contents(&mut writer)?;
        writer.flush()?;
        drop(writer);
        temporary.file.sync_all()?;
        fs::rename(&temporary.path, &self.target)
    }
}

/// A file beside another one, removed if it has not been renamed when it goes out of scope.
struct Temporary {
    path: PathBuf,
    file: File,
}

impl Temporary {
    fn create(beside: &Path) -> io::Result<Self> {
        let mut number = 0_u32;
        loop {
            let mut name = beside.file_name().unwrap_or_default().to_owned();
            name.push(format!(".{}.{number}.tmp", std::process::id()));
            let path = beside.with_file_name(name);
            match File::create_new(&path) {
                // One that was killed has left it, with the same number of a process: in a container that is not rare.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => number += 1,
                file => return Ok(Self { path, file: file? }),
            }
        }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // After the renaming there is nothing to remove; and there is no one to tell of a failure.
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_but_the_file_is_left_behind() {
        let folder = std::env::temp_dir().join(format!("isect-output-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let file = folder.join("picture.png");
        let output = Output::new(&file).unwrap();
        assert!(!file.exists());
        output.write(|file| file.write_all(b"whole")).unwrap();
        let failed = output.write(|file| {
            file.write_all(b"half")?;
            Err(io::Error::other("full"))
        });
        assert!(failed.is_err());
        let names: Vec<_> = fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()).collect();
        assert_eq!(names, [file.as_path()]);
        assert_eq!(fs::read(&file).unwrap(), b"whole");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_a_killed_process_left_is_no_obstacle() {
        let folder = std::env::temp_dir().join(format!("isect-killed-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let file = folder.join("picture.png");
        std::mem::forget(Temporary::create(&file).unwrap());
        Output::new(&file).unwrap().write(|file| file.write_all(b"whole")).unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"whole");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
        fs::remove_dir_all(&folder).unwrap();
    }
}

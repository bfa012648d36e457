//! What a surface does with light that it reflects or refracts: glam knows the directions, this the shares.
//!
//! T. Whitted, "An Improved Illumination Model for Shaded Display", CACM 23.6, 1980, with Fresnel's
//! equations, or Schlick's, in the place of his constant shares. Directions and normals have length 1; the normal
//! points to the side from which the light comes.

use isect::glam::Vec3A;

/// The share of the light that an opaque surface mirrors, `straight` of it at normal incidence and
/// all at grazing: C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994.
pub(crate) fn mirrored_share(direction: Vec3A, normal: Vec3A, straight: f32) -> f32 {
    let cos_i = (-normal.dot(direction)).clamp(0.0, 1.0);
    straight + (1.0 - straight) * (1.0 - cos_i).powi(5)
}

/// A ray that passes into another medium.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Refraction {
    /// Where it goes on.
    pub(crate) direction: Vec3A,
    /// The share of the light that does not: it is reflected.
    pub(crate) reflectance: f32,
}

/// A ray that passes into another medium, with η = `n_i/n_r`. `None` where all light is reflected.
pub(crate) fn refract(direction: Vec3A, normal: Vec3A, eta: f32) -> Option<Refraction> {
    let refracted = direction.refract(normal, eta);
    if refracted == Vec3A::ZERO {
        return None;
    }
    let [cos_i, cos_r] = [direction, refracted].map(|v| (-normal.dot(v)).clamp(0.0, 1.0));
    // Fresnel's amplitudes across and along the plane of incidence; their mean square for light
    // that is not polarised.
    let across = (eta * cos_i - cos_r) / (eta * cos_i + cos_r);
    let along = (cos_i - eta * cos_r) / (cos_i + eta * cos_r);
    let reflectance = ((across * across + along * along) / 2.0).min(1.0);
    Some(Refraction { direction: refracted, reflectance })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The direction that comes down onto the plane y = 0, `angle` away from its normal.
    fn incident(angle: f32) -> Vec3A {
        Vec3A::new(angle.sin(), -angle.cos(), 0.0)
    }

    #[test]
    fn refraction_obeys_snell() {
        for eta in [1.0 / 1.5, 1.0, 1.5] {
            for degrees in [0.0_f32, 10.0, 25.0, 40.0] {
                let direction = incident(degrees.to_radians());
                let refracted = refract(direction, Vec3A::Y, eta).expect("below 41.8°");
                let sin_r = eta * direction.x;
                assert!((refracted.direction.x - sin_r).abs() < 1e-6);
                assert!(refracted.direction.y < 0.0 && refracted.direction.z == 0.0);
                assert!((refracted.direction.length() - 1.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn beyond_the_critical_angle_all_light_is_reflected() {
        let critical = (1.0_f32 / 1.5).asin();
        let at = |angle| refract(incident(angle), Vec3A::Y, 1.5);
        assert!(at(critical + 1e-3).is_none());
        let grazing = at(critical - 1e-3).expect("below the critical angle");
        assert!(grazing.direction.y > -0.1 && grazing.reflectance > 0.6);
        assert!(refract(incident(1.57), Vec3A::Y, 1.0 / 1.5).is_some());
    }

    #[test]
    fn glass_reflects_four_percent_at_normal_incidence() {
        for eta in [1.5, 1.0 / 1.5] {
            let refracted = refract(incident(0.0), Vec3A::Y, eta).expect("straight down");
            assert!((refracted.reflectance - 0.04).abs() < 1e-6);
        }
    }

    #[test]
    fn a_grazing_look_sees_a_mirror() {
        let share = |angle| mirrored_share(incident(angle), Vec3A::Y, 0.04);
        assert_eq!(share(0.0), 0.04);
        assert!(share(0.5) < 0.05 && share(1.57) > 0.99);
    }
}

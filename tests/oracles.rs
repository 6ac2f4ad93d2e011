//! Pins the double-precision oracles to published values and to identities, so that the modules are compared with the right thing.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, DVec4};
use shadewright::modules::oracles::display::*;
use shadewright::modules::oracles::lights::*;
use shadewright::modules::oracles::quadrature::{direction, hemisphere, nodes};
use shadewright::modules::oracles::reflection::*;
use shadewright::modules::oracles::shadows::*;

/// Asserts a relative difference.
#[track_caller]
fn near(got: f64, expected: f64, relative: f64) {
    assert!(
        (got - expected).abs() <= relative * expected.abs(),
        "got {got}, expected {expected}"
    );
}

fn deg(x: f64) -> f64 {
    x.to_radians()
}

/// Catches a wrong power of the cosine, roughness taken for alpha, or a wrong factor of pi.
#[test]
fn ggx_distribution() {
    near(ggx_d(0.002025, 0.0), 77624.72457, 1e-9);
    near(ggx_d(0.002025, deg(0.1)), 25555.17836, 1e-9);
    near(ggx_d(0.007921, deg(0.5)), 1035.306447, 1e-9);
    near(ggx_d(1e-4, deg(0.01)), 1944289.756, 1e-9);
    for alpha in [0.05, 0.3, 1.0] {
        let sum: f64 = nodes(0.0, FRAC_PI_2, 400)
            .iter()
            .map(|&(t, w)| 2.0 * PI * w * ggx_d(alpha, t) * t.cos() * t.sin())
            .sum();
        near(sum, 1.0, 1e-9);
    }
}

/// Catches G1 with roughness for alpha, and correlated and separable forms mistaken for each other.
#[test]
fn smith_masking() {
    near(ggx_g1(0.5, deg(60.0)), 0.861001748, 1e-8);
    near(ggx_g1(0.01, deg(89.9)), 0.293419307, 1e-8);
    near(ggx_g2_correlated(1.0, deg(80.0), deg(80.0)), 0.173648178, 1e-8);
    near(ggx_g2_separable(1.0, deg(80.0), deg(80.0)), 0.087563799, 1e-8);
    near(1.0 / (1.0 + ggx_lambda(0.3, deg(70.0))), ggx_g1(0.3, deg(70.0)), 1e-14);
}

/// The visible facets together cover what the surface covers (Heitz 2014, eq. 16): ties D to G1.
#[test]
fn projected_area_is_conserved() {
    let theta = deg(85.0);
    let v = direction(theta, 0.0);
    let facets = hemisphere(200, 100);
    let area: f64 = facets
        .iter()
        .map(|(h, w)| w * ggx_g1(0.5, theta) * v.dot(*h).max(0.0) * ggx_d(0.5, angle(DVec3::Z, *h)))
        .sum();
    near(area, 0.0871557427, 1e-5);
}

#[test]
fn fresnel() {
    near(fresnel_dielectric(1.0, 1.5, deg(60.0)), 0.089186713, 1e-8);
    near(fresnel_dielectric(1.0, 1.5, deg(85.0)), 0.612799645, 1e-8);
    assert_eq!(fresnel_dielectric(1.5, 1.0, deg(41.9)), 1.0);
    let mean = |f: &dyn Fn(f64) -> f64| -> f64 { nodes(0.0, FRAC_PI_2, 100).iter().map(|&(t, w)| w * f(t) * (2.0 * t).sin()).sum() };
    near(mean(&|t| fresnel_dielectric(1.0, 1.5, t)), 0.091777959, 1e-7);
    near(mean(&|t| schlick(0.04, t.cos())), 0.085714286, 1e-8);
    near(
        schlick(0.04, deg(85.0).cos()) - fresnel_dielectric(1.0, 1.5, deg(85.0)),
        0.0357,
        1e-2,
    );
}

/// The albedo of white facets at alpha 1 has a closed form: ties D, G and the 4 n.l n.v together.
#[test]
fn white_furnace() {
    let s = Surface {
        normal: DVec3::Z,
        diffuse: 0.0,
        f0: 1.0,
        alpha: 1.0,
    };
    for (mu, expected) in [(1.0, 0.306852819), (0.5, 0.450693856), (0.1, 0.760210473)] {
        let v = direction(f64::acos(mu), 0.0);
        let albedo: f64 = hemisphere(60, 60).iter().map(|(l, w)| w * microfacet(&s, v, *l) * l.z).sum();
        near(1.0 - mu * (1.0 + 1.0 / mu).ln(), expected, 1e-8);
        near(albedo, expected, 1e-5);
    }
}

#[test]
fn microfacet_is_reciprocal_and_zero_below_the_horizon() {
    let s = Surface {
        normal: DVec3::Z,
        diffuse: 0.3,
        f0: 0.04,
        alpha: 0.2,
    };
    let (v, l) = (direction(deg(70.0), 0.0), direction(deg(20.0), 2.0));
    near(microfacet(&s, v, l), microfacet(&s, l, v), 1e-14);
    assert_eq!(microfacet(&s, v, -l), 0.0);
    assert_eq!(microfacet(&s, -v, l), 0.0);
    near(lambert(0.5) * PI, 0.5, 1e-15);
}

/// Catches the 1 that is added to the squared distance, a window of another power, lumen spread over 2 pi.
#[test]
fn light_falloff() {
    near(candela(1400.0), 111.40846, 1e-7);
    near(falloff_karis(5.0, 10.0), 0.0338040865, 1e-8);
    near(falloff(5.0, 10.0, 0.01), 0.03515625, 1e-12);
    near(falloff(5.0, 0.0, 0.01), 0.04, 1e-12);
    near(falloff(0.001, 0.0, 0.01), 1e4, 1e-12);
    assert_eq!(falloff(11.0, 10.0, 0.01), 0.0);
    let light = Point {
        position: DVec3::new(0.0, 3.0, 4.0),
        intensity: 100.0,
        range: 0.0,
        size: 0.01,
    };
    near(point_illuminance(&light, DVec3::ZERO, DVec3::Z), 3.2, 1e-14);
    assert_eq!(point_illuminance(&light, DVec3::ZERO, DVec3::NEG_Z), 0.0);
    near(directional_illuminance(DVec3::new(0.0, 3.0, -4.0), 1000.0, DVec3::Z), 800.0, 1e-14);
}

/// Catches a cone measured by its whole opening, a ramp in the angle, and one that is not 0 beyond.
#[test]
fn spots() {
    near(1400.0 / cone_solid_angle(deg(30.0)), 1663.12813, 1e-8);
    near(cone_solid_angle(PI), 4.0 * PI, 1e-15);
    let versine = |x: f64| 1.0 - deg(x).cos();
    near(
        cone_ramp(versine(30.0), versine(20.0), versine(40.0)),
        (deg(30.0).cos() - deg(40.0).cos()) / (deg(20.0).cos() - deg(40.0).cos()),
        1e-14,
    );
    assert_eq!(cone_ramp(versine(41.0), versine(20.0), versine(40.0)), 0.0);
    assert_eq!(cone_ramp(0.0, 0.0, 0.0), 0.0);
    let point = Point {
        position: DVec3::new(0.0, 3.0, 4.0),
        intensity: 100.0,
        range: 0.0,
        size: 0.01,
    };
    let spot = |direction| Spot {
        point,
        direction,
        inner: deg(10.0),
        outer: deg(20.0),
    };
    near(
        spot_illuminance(&spot(DVec3::new(0.0, -6.0, -8.0)), DVec3::ZERO, DVec3::Z),
        3.2,
        1e-14,
    );
    assert_eq!(spot_illuminance(&spot(DVec3::NEG_Z), DVec3::ZERO, DVec3::Z), 0.0);
    assert_eq!(spot_illuminance(&spot(DVec3::ZERO), DVec3::ZERO, DVec3::Z), 0.0);
}

/// Catches a disc that the horizon cuts in the wrong place, and a mean over slopes that is not one: Gauss-Legendre over the disc.
#[test]
fn discs() {
    near(disc_cosine(DVec3::Z, DVec3::new(0.6, 0.0, 0.8), 0.1), 0.8, 1e-14);
    // Half of a small disc above the horizon: the mean of the positive half of x over a disc of radius r is 2 r / (3 pi).
    near(disc_cosine(DVec3::Z, DVec3::X, 1e-3), 2e-3 / (3.0 * PI), 1e-5);
    assert_eq!(disc_cosine(DVec3::Z, DVec3::new(1.0, 0.0, -0.2), 0.1), 0.0);
    for (alpha, slope, radius) in [(0.1, 0.0, 0.05), (0.01, 0.02, 0.03), (0.02, 0.2, 0.01)] {
        let ggx = |square: f64| (alpha / (alpha * alpha + square)).powi(2) / PI;
        let sum: f64 = nodes(0.0, radius, 40)
            .iter()
            .flat_map(|&(r, wr)| nodes(0.0, 2.0 * PI, 40).into_iter().map(move |(phi, wp)| (r, phi, wr * wp)))
            .map(|(r, phi, w)| w * r * ggx(slope * slope + r * r + 2.0 * slope * r * phi.cos()))
            .sum();
        near(
            disc_over_ggx(alpha, slope, radius, radius),
            sum / (PI * radius * radius) / ggx(slope * slope),
            1e-7,
        );
    }
    assert!(disc_over_ggx(0.5, 3.0, 1e-5, 1e-5) - 1.0 < 1e-4);
}

#[test]
fn exposure_and_tone() {
    near(ev100(16.0, 1.0 / 125.0, 100.0), 14.9657843, 1e-8);
    near(saturation_luminance(ev100(16.0, 1.0 / 125.0, 100.0)), 38400.0, 1e-12);
    near(reinhard_extended(4.0, 4.0), 1.0, 1e-15);
    near(reinhard_extended(8.0, 4.0), 1.3333333333, 1e-9);
    let c = reinhard_color(DVec3::new(8.0, 1.0, 0.1), 1e9);
    near(c.x, 2.337, 1e-3);
    near(c.y, 0.292, 2e-3);
    near(c.z, 0.029, 1e-2);
    assert_eq!(reinhard_color(DVec3::ZERO, 4.0), DVec3::ZERO);
    near(log_average(&[0.01, 0.1, 1.0, 10.0, 100.0], 1e-4), 1.00221461, 1e-8);
    near(log_average(&[0.0, 0.0, 0.0, 1.0], 1e-4), 0.001, 1e-3);
}

#[test]
fn srgb() {
    near(srgb_decode(0.5), 0.214041140, 1e-8);
    near(srgb_encode(0.18), 0.461356130, 1e-8);
    for i in 0..=255 {
        let c = f64::from(i) / 255.0;
        assert!((srgb_encode(srgb_decode(c)) - c).abs() < 1e-7);
    }
}

/// Catches depth ranges of other conventions (-1 to 1, reversed) and a flipped axis.
#[test]
fn projections() {
    near(perspective_depth(10.0, 0.1, 10.0), 1.0, 1e-15);
    assert!(perspective_depth(0.1, 0.1, 10.0).abs() < 1e-15);
    near(perspective_depth(1.0, 0.1, 10.0), 10.0 * 0.9 / 9.9, 1e-14);
    let p = perspective(FRAC_PI_2, 2.0, 0.1, 10.0) * DVec4::new(2.0, 1.0, -1.0, 1.0);
    near(p.x / p.w, 1.0, 1e-14);
    near(p.y / p.w, 1.0, 1e-14);
    let o = orthographic(4.0, 2.0, 1.0, 3.0) * DVec4::new(2.0, -1.0, -2.0, 1.0);
    assert!((o - DVec4::new(1.0, -1.0, 0.5, 1.0)).length() < 1e-15, "{o}");
}

/// The matrix of a face puts a point where the cube's addressing looks for it. Catches a turned or mirrored face.
#[test]
fn cube_faces_agree_with_their_matrices() {
    let light = DVec3::new(1.0, 2.0, 3.0);
    let mut seen = [false; 6];
    for (d, _) in hemisphere(3, 4).into_iter().flat_map(|(d, w)| [(d, w), (-d, w)]) {
        let (face, u, v) = cube_face(d);
        seen[face] = true;
        let clip = cube_view_projection(face, light, 0.1, 10.0) * (light + d * 3.0).extend(1.0);
        near(clip.w, 3.0 * d.abs().max_element(), 1e-12);
        assert!((clip.x / clip.w * 0.5 + 0.5 - u).abs() < 1e-12 && (0.5 - clip.y / clip.w * 0.5 - v).abs() < 1e-12);
        near(clip.z / clip.w, perspective_depth(clip.w, 0.1, 10.0), 1e-12);
    }
    assert_eq!(seen, [true; 6]);
    // From the table of the Vulkan specification, "Cube Map Face Selection": (s, t) is (-z, -y), (z, -y), (x, z), (x, -z), (x, -y), (-x, -y).
    assert_eq!(cube_face(DVec3::new(1.0, 0.5, -0.5)), (0, 0.75, 0.25));
    assert_eq!(cube_face(DVec3::new(-1.0, 0.5, -0.5)), (1, 0.25, 0.25));
    assert_eq!(cube_face(DVec3::new(0.5, 1.0, 0.25)), (2, 0.75, 0.625));
    assert_eq!(cube_face(DVec3::new(0.5, -1.0, 0.25)), (3, 0.75, 0.375));
    assert_eq!(cube_face(DVec3::new(0.5, 0.25, 1.0)), (4, 0.75, 0.375));
    assert_eq!(cube_face(DVec3::new(0.5, 0.25, -1.0)), (5, 0.25, 0.375));
}

#[test]
fn shadow_filter() {
    near(tent_filter(2, |_, _| true), 1.0, 1e-15);
    near(tent_filter(1, |x, _| x < 1), 0.75, 1e-15);
    assert_eq!(tent_filter(0, |x, y| x == 0 && y == 0), 1.0);
    assert!(lit(0.5, 0.5) && !lit(0.6, 0.5));
}

//! Illuminance from lights. Metres, candela, lux.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::quadrature::nodes;
use super::reflection::angle;

/// A light with a position.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// m
    pub position: DVec3,
    /// cd
    pub intensity: f64,
    /// Where it has faded, m; 0 for never.
    pub range: f64,
    /// Nearer than this its illuminance does not grow, m.
    pub size: f64,
}

/// Candela of a light that sends a flux in lumen alike into all directions.
pub fn candela(lumen: f64) -> f64 {
    lumen / (4.0 * PI)
}

/// The window that takes a light to 0 at its range. Karis 2013, eq. 9, numerator.
pub fn window(distance: f64, range: f64) -> f64 {
    if range == 0.0 {
        return 1.0;
    }
    (1.0 - (distance / range).powi(4)).clamp(0.0, 1.0).powi(2)
}

/// Windowed falloff with 1 added to the squared distance: Karis 2013, eq. 9 as printed (in that engine's centimetres).
pub fn falloff_karis(distance: f64, range: f64) -> f64 {
    window(distance, range) / (distance * distance + 1.0)
}

/// Windowed inverse square, the distance kept from 0. Lagarde and de Rousiers 2014.
pub fn falloff(distance: f64, range: f64, size: f64) -> f64 {
    window(distance, range) / distance.max(size).powi(2)
}

/// What a spot light's edge makes of: linear in the cosine, 1 within the inner angle, 0 beyond the outer one; all three as 1 - cos.
/// KHR_lights_punctual. Angles that differ by less than 1e-10 in 1 - cos are an edge.
pub fn cone_ramp(versine: f64, inner: f64, outer: f64) -> f64 {
    ((outer - versine) / (outer - inner).max(1e-10)).clamp(0.0, 1.0)
}

/// Solid angle of a cone of this half angle, sr.
pub fn cone_solid_angle(half_angle: f64) -> f64 {
    4.0 * PI * (half_angle / 2.0).sin().powi(2)
}

/// A light that shines into a cone.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// Place, intensity on the axis, range and size.
    pub point: Point,
    /// Axis, where the light travels to, any length.
    pub direction: DVec3,
    /// Angle to the axis up to which all of the light is there.
    pub inner: f64,
    /// Angle to the axis at which it ends.
    pub outer: f64,
}

/// Illuminance of a surface with unit normal `n` at `place`, lx. Lagarde and de Rousiers 2014, on spot lights.
pub fn spot_illuminance(light: &Spot, place: DVec3, n: DVec3) -> f64 {
    let versine = |angle: f64| 2.0 * (angle / 2.0).sin().powi(2);
    if light.direction == DVec3::ZERO {
        return 0.0;
    }
    let theta = angle(light.direction, place - light.point.position);
    let ramp = cone_ramp(versine(theta), versine(light.inner), versine(light.outer));
    ramp * ramp * point_illuminance(&light.point, place, n)
}

/// Illuminance of a surface with unit normal `n` at `place`, lx.
pub fn point_illuminance(light: &Point, place: DVec3, n: DVec3) -> f64 {
    let r = light.position - place;
    let d = r.length();
    if d == 0.0 {
        return 0.0;
    }
    light.intensity * falloff(d, light.range, light.size) * (n.dot(r) / d).max(0.0)
}

/// Mean angle that the sun takes up seen from the earth, 0.533 degrees.
pub const SUN_DIAMETER: f64 = 0.009_302_604_913;

/// Illuminance of a surface with unit normal `n` by a uniform disc around `toward` whose rim is `radius` away from it, for 1 lx of a
/// surface perpendicular to its centre; the part of the disc below the horizon gives none. Lambert 1760, integrated.
pub fn disc_cosine(n: DVec3, toward: DVec3, radius: f64) -> f64 {
    let theta = angle(n, toward);
    let rim = radius.sin();
    if theta + radius <= FRAC_PI_2 || rim == 0.0 {
        // All of it is above the horizon: its illuminance vector has the direction of its centre.
        return theta.cos().max(0.0);
    }
    // Seen along its axis the disc is flat; strips across the plane of n, from where they rise above the horizon.
    let strips = nodes(-FRAC_PI_2, FRAC_PI_2, 64);
    let strip = |&(turn, weight): &(f64, f64)| {
        let (x, half) = (rim * turn.sin(), rim * turn.cos());
        let along: f64 = nodes(0.0, half, 16)
            .iter()
            .map(|&(y, w)| w * (theta.cos() + theta.sin() * x / (1.0 - x * x - y * y).sqrt()).max(0.0))
            .sum();
        2.0 * along * weight * half
    };
    strips.iter().map(strip).sum::<f64>() / (PI * rim * rim)
}

/// Mean of GGX over a small disc of slopes, over its value in the disc's middle, which is `slope` away from the peak. A round disc has `reach` =
/// `size` = its radius; for an ellipse `reach` is its radius toward the peak, `size` that of the disc with its area.
///
/// GGX has the integrand of the configuration factor from an element at the height alpha to a parallel disc (Siegel and Howell 2002, appendix C).
pub fn disc_over_ggx(alpha: f64, slope: f64, reach: f64, size: f64) -> f64 {
    let excess = alpha.powi(2) + slope.powi(2) - reach.powi(2);
    let root = excess.hypot(2.0 * alpha * reach);
    // (1 - excess / root) / 2; far from the peak that difference is below what f64 resolves.
    let factor = if excess > 0.0 {
        2.0 * (alpha * reach).powi(2) / (root * (root + excess))
    } else {
        (root - excess) / (2.0 * root)
    };
    let area = reach.powi(2) + factor * (size.powi(2) - reach.powi(2));
    factor * (alpha.powi(2) + slope.powi(2)).powi(2) / (alpha.powi(2) * area)
}

/// Illuminance of a surface with unit normal `n` by parallel rays that travel along `direction`, lx. Lambert 1760.
pub fn directional_illuminance(direction: DVec3, illuminance: f64, n: DVec3) -> f64 {
    illuminance * (-n.dot(direction) / direction.length()).max(0.0)
}

//! `.bsdf` files: a grid that follows the material's own lobe (Dupuy and Jakob 2018, An Adaptive Parameterization for Efficient Material Acquisition
//! and Rendering).
//!
//! For each incident direction the half vector is mapped to the unit square by the distribution of the visible facets' normals, `vndf`, and what was
//! measured stands evenly on that square. With the distribution of normals D, `ndf`, and the facets' projected area, `sigma`:
//!
//! ```text
//! f(i, o) cos(o) = rgb D(m) / (4 sigma(i))
//! ```
//!
//! Here i is the direction to the viewer, o the one to the light: such a file is not reciprocal beyond what its material and the measurement are.
//! Elevation theta stands at u = sqrt(2 theta / pi), azimuth phi at u = (phi + pi) / (2 pi).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};

use super::tensor::{Entry, fields};
use super::warp::{Warp, bilinear};
use super::{Damaged, Sample, is_within, spread};

/// Values on a grid of the unit square.
#[derive(Clone, Debug, PartialEq)]
struct Grid {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

impl Grid {
    fn at(&self, u: DVec2) -> f64 {
        bilinear(&self.values, self.width, self.height, u)
    }
}

/// A table that follows the material's lobe.
#[derive(Clone, Debug, PartialEq)]
pub struct Rgl {
    /// Azimuths of the incident directions, rad, ascending; one or two of an isotropic material.
    phi_i: Vec<f32>,
    /// Elevations of the incident directions, rad, ascending.
    theta_i: Vec<f32>,
    /// How often the azimuths of the file go round: 1, 2 or 4.
    symmetry: usize,
    /// Whether the values are to be multiplied by D / (4 sigma).
    has_jacobian: bool,
    ndf: Grid,
    sigma: Grid,
    vndf: Warp,
    /// A slice for each azimuth, elevation and channel.
    rgb: Grid,
}

impl Rgl {
    /// Reads a file. It must have the form with red, green and blue; the spectral one is refused.
    ///
    /// # Errors
    /// The file is no tensor file, a field is missing, of another type or size, or has numbers that cannot be.
    pub fn read(bytes: &[u8]) -> Result<Self, Damaged> {
        let fields = fields(bytes)?;
        let find = |name: &str| fields.iter().find(|field| field.name == name);
        if let (Some(spectra), None) = (find("spectra"), find("rgb")) {
            return Err(Damaged::new(
                spectra.at,
                "a field `rgb`: the collection has every material in this form too",
                "`spectra`, a table by wavelength",
            ));
        }
        let need = |name: &str| {
            find(name).ok_or_else(|| {
                let names: Vec<String> = fields.iter().map(|field| format!("`{}`", field.name)).collect();
                Damaged::new(
                    18,
                    format!("a field `{name}`"),
                    if names.is_empty() { "none".into() } else { names.join(", ") },
                )
            })
        };
        let phi_i = angles(need("phi_i")?, [-TAU, TAU])?;
        let theta_i = angles(need("theta_i")?, [0.0, FRAC_PI_2 + 1e-4])?;
        let directions = [phi_i.len(), theta_i.len()];
        let vndf = warp(need("vndf")?, directions)?;
        let rgb = need("rgb")?;
        let (width, height) = match rgb.shape[..] {
            [p, t, 3, height, width] if [p, t] == directions => (width, height),
            _ => {
                let [p, t] = directions;
                let expected = format!("`rgb` of {p} x {t} x 3 x height x width, as `phi_i` and `theta_i` are");
                return Err(Damaged::new(rgb.at, expected, sizes(&rgb.shape)));
            }
        };
        sides(rgb, [width, height])?;
        let has_jacobian = match find("jacobian") {
            None => true,
            Some(field) => field.bytes()?.first().is_some_and(|flag| *flag != 0),
        };
        Ok(Self {
            symmetry: symmetry(need("phi_i")?, &phi_i)?,
            phi_i,
            theta_i,
            has_jacobian,
            ndf: grid(need("ndf")?)?,
            sigma: grid(need("sigma")?)?,
            vndf,
            rgb: Grid {
                width,
                height,
                values: rgb.floats()?,
            },
        })
    }

    /// Whether turning the surface in its plane changes nothing.
    pub fn is_isotropic(&self) -> bool {
        self.phi_i.len() <= 2
    }

    /// How many azimuths and elevations of incident directions, and how many values along and across the square for each.
    pub fn sizes(&self) -> [usize; 4] {
        [self.phi_i.len(), self.theta_i.len(), self.rgb.width, self.rgb.height]
    }

    /// See [`super::Measured::samples`].
    pub fn samples(&self, count: usize, most: f64) -> Vec<Sample> {
        let (w, h) = (self.rgb.width, self.rgb.height);
        let mut samples = Vec::new();
        // At the square's edges many values share a direction.
        let inner = [self.phi_i.len(), self.theta_i.len(), h.saturating_sub(2), w.saturating_sub(2)];
        if inner.contains(&0) {
            return samples;
        }
        spread(inner, count, |[p, t, y, x]| {
            let slice = p * self.theta_i.len() + t;
            let (phi, theta) = (f64::from(self.phi_i[p]), f64::from(self.theta_i[t]));
            let v = direction(theta, phi);
            let even = DVec2::new((x + 1) as f64 / (w - 1) as f64, (y + 1) as f64 / (h - 1) as f64);
            let m = self.vndf.sample(slice, even);
            let phi_m = (2.0 * m.y - 1.0) * PI + if self.is_isotropic() { phi } else { 0.0 };
            let half = direction(m.x * m.x * FRAC_PI_2, phi_m);
            let l = 2.0 * v.dot(half) * half - v;
            let sigma = self.sigma.at(DVec2::new((theta / FRAC_PI_2).sqrt(), (phi + PI) / TAU));
            if l.z <= 0.0 || sigma <= 0.0 || !is_within(v, l, most) {
                return false;
            }
            let scale = if self.has_jacobian { self.ndf.at(m) / (4.0 * sigma) } else { 1.0 };
            let value = |channel: usize| {
                let index = ((slice * 3 + channel) * h + y + 1) * w + x + 1;
                f64::from(self.rgb.values[index]).max(0.0) * scale / l.z
            };
            samples.push(Sample {
                v,
                l,
                value: std::array::from_fn(value),
            });
            true
        });
        samples
    }

    /// The table for a shader: sixteen numbers (azimuths, elevations, width and height of ndf, sigma, vndf and values, 1 for an isotropic table, the
    /// symmetry, 1 for a table with D / (4 sigma), three times 0), azimuths, elevations, ndf, sigma, of vndf the densities, the conditional and the
    /// marginal distributions, and the values, slices of azimuth, elevation and channel. Negative values, colours out of gamut, are 0.
    pub fn floats(&self) -> Vec<f32> {
        let flag = |on: bool| if on { 1.0 } else { 0.0 };
        let sizes = [
            self.phi_i.len(),
            self.theta_i.len(),
            self.ndf.width,
            self.ndf.height,
            self.sigma.width,
            self.sigma.height,
            self.vndf.width,
            self.vndf.height,
            self.rgb.width,
            self.rgb.height,
        ];
        let mut floats: Vec<f32> = sizes.iter().map(|size| *size as f32).collect();
        floats.extend([
            flag(self.is_isotropic()),
            self.symmetry as f32,
            flag(self.has_jacobian),
            0.0,
            0.0,
            0.0,
        ]);
        for part in [&self.phi_i, &self.theta_i, &self.ndf.values, &self.sigma.values] {
            floats.extend(part);
        }
        for part in [&self.vndf.values, &self.vndf.conditional, &self.vndf.marginal] {
            floats.extend(part);
        }
        floats.extend(self.rgb.values.iter().map(|x| x.max(0.0)));
        floats
    }
}

/// The unit vector at these angles, rad.
pub fn direction(theta: f64, phi: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

fn sizes(shape: &[usize]) -> String {
    let sizes: Vec<String> = shape.iter().map(usize::to_string).collect();
    sizes.join(" x ")
}

/// Angles of a field, ascending, between two bounds.
fn angles(field: &Entry<'_>, bounds: [f64; 2]) -> Result<Vec<f32>, Damaged> {
    if field.shape.len() != 1 || field.shape[0] == 0 {
        return Err(Damaged::new(
            field.at,
            format!("`{}` of one dimension", field.name),
            sizes(&field.shape),
        ));
    }
    let angles = field.floats()?;
    for (index, angle) in angles.iter().enumerate() {
        let least = if index > 0 { f64::from(angles[index - 1]) } else { bounds[0] };
        let is_more = index == 0 || f64::from(*angle) > least;
        if !is_more || f64::from(*angle) < bounds[0] || f64::from(*angle) > bounds[1] {
            let expected = format!("`{}` ascending, from {:.4} to {:.4}", field.name, bounds[0], bounds[1]);
            return Err(Damaged::new(field.offset + 4 * index, expected, angle.to_string()));
        }
    }
    Ok(angles)
}

/// How often the azimuths go round.
fn symmetry(field: &Entry<'_>, phi_i: &[f32]) -> Result<usize, Damaged> {
    let [first, .., last] = phi_i else { return Ok(1) };
    if phi_i.len() == 2 {
        return Ok(1);
    }
    let span = f64::from(last - first);
    let times = (TAU / span).round();
    // The shader folds azimuths to where the file has them: from -pi on.
    let begins = (f64::from(*first) + PI).abs() < 0.1;
    match times as usize {
        1 => Ok(1),
        2 if begins => Ok(2),
        4 if begins => Ok(4),
        _ => Err(Damaged::new(
            field.offset,
            "azimuths all round, or a half or a quarter round from -pi",
            format!("{first} to {last}"),
        )),
    }
}

/// A grid of numbers from 0 on.
fn grid(field: &Entry<'_>) -> Result<Grid, Damaged> {
    let [height, width] = field.shape[..] else {
        return Err(Damaged::new(
            field.at,
            format!("`{}` of two dimensions", field.name),
            sizes(&field.shape),
        ));
    };
    let values = densities(field, [width, height])?;
    Ok(Grid { width, height, values })
}

fn warp(field: &Entry<'_>, directions: [usize; 2]) -> Result<Warp, Damaged> {
    let (width, height) = match field.shape[..] {
        [p, t, height, width] if [p, t] == directions => (width, height),
        _ => {
            let [p, t] = directions;
            let expected = format!("`{}` of {p} x {t} x height x width, as `phi_i` and `theta_i` are", field.name);
            return Err(Damaged::new(field.at, expected, sizes(&field.shape)));
        }
    };
    Warp::new(width, height, densities(field, [width, height])?).map_err(|slice| {
        let at = field.offset + slice * width * height * 4;
        Damaged::new(
            at,
            format!("a distribution in slice {slice} of `{}`", field.name),
            "nothing but zeros, or sums too small to divide by",
        )
    })
}

/// There is something to interpolate between, and a shader can count it in floats.
fn sides(field: &Entry<'_>, size: [usize; 2]) -> Result<(), Damaged> {
    if size.iter().all(|side| (2..=4096).contains(side)) {
        return Ok(());
    }
    let expected = format!("a grid of `{}` with 2 to 4096 points along each side", field.name);
    Err(Damaged::new(field.at, expected, sizes(&field.shape)))
}

/// Numbers from 0 on, on a grid.
fn densities(field: &Entry<'_>, size: [usize; 2]) -> Result<Vec<f32>, Damaged> {
    sides(field, size)?;
    let values = field.floats()?;
    if let Some(index) = values.iter().position(|x| *x < 0.0) {
        let expected = format!("a number from 0 on in `{}`", field.name);
        return Err(Damaged::new(field.offset + 4 * index, expected, values[index].to_string()));
    }
    Ok(values)
}

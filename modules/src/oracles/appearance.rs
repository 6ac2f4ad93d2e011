//! What a material gives, in the order of the interface's members.

use glam::{DVec2, DVec3};

use super::At;

/// All numbers of a surface; `bare` is one of which nothing is said.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "named and explained as in modules/material/interface.wgsl")]
pub struct Appearance {
    pub position: DVec3,
    pub normal: DVec3,
    pub geometric_normal: DVec3,
    pub diffuse: DVec3,
    pub diffuse_roughness: f64,
    pub f0: DVec3,
    pub f90: DVec3,
    pub f82: DVec3,
    pub alpha: f64,
    pub tangent: DVec3,
    pub widths: DVec2,
    pub emission: DVec3,
    pub opacity: f64,
    pub coat: f64,
    pub coat_alpha: f64,
    pub coat_ior: f64,
    pub coat_color: DVec3,
    pub coat_normal: DVec3,
    pub fuzz: f64,
    pub fuzz_color: DVec3,
    pub fuzz_roughness: f64,
}

impl Appearance {
    /// At the fragment `at` among the arguments, without a normal map.
    pub fn bare(at: &At) -> Self {
        let normal = at.vector("at.normal");
        // The tangent as interpolated, made orthogonal to the normal.
        let along = at.vector("at.tangent");
        Self {
            position: at.vector("at.position"),
            normal,
            geometric_normal: normal,
            diffuse: DVec3::ZERO,
            diffuse_roughness: 0.0,
            f0: DVec3::ZERO,
            f90: DVec3::ONE,
            f82: DVec3::ONE,
            alpha: 1.0,
            tangent: (along - normal * normal.dot(along)).normalize(),
            widths: DVec2::ONE,
            emission: DVec3::ZERO,
            opacity: 1.0,
            coat: 0.0,
            coat_alpha: 1.0,
            coat_ior: 1.5,
            coat_color: DVec3::ONE,
            coat_normal: normal,
            fuzz: 0.0,
            fuzz_color: DVec3::ONE,
            fuzz_roughness: 0.5,
        }
    }

    /// The numbers, vectors component by component.
    pub fn numbers(&self) -> Vec<f64> {
        let mut all = Vec::new();
        for vector in [self.position, self.normal, self.geometric_normal, self.diffuse] {
            all.extend(vector.to_array());
        }
        all.push(self.diffuse_roughness);
        all.extend(self.f0.to_array());
        all.extend(self.f90.to_array());
        all.extend(self.f82.to_array());
        all.push(self.alpha);
        all.extend(self.tangent.to_array());
        all.extend(self.widths.to_array());
        all.extend(self.emission.to_array());
        all.extend([self.opacity, self.coat, self.coat_alpha, self.coat_ior]);
        all.extend(self.coat_color.to_array());
        all.extend(self.coat_normal.to_array());
        all.push(self.fuzz);
        all.extend(self.fuzz_color.to_array());
        all.push(self.fuzz_roughness);
        all
    }
}

/// Smallest width of a lobe, as the shader has it: in 32 bits.
pub fn smallest_alpha() -> f64 {
    f64::from(1e-4_f32)
}

/// Roughness squared (Burley 2012, section 5.4), and at least the smallest width.
pub fn alpha(roughness: f64) -> f64 {
    roughness.powi(2).max(smallest_alpha())
}

/// Reflectance of a boundary along its normal. Fresnel 1823.
pub fn normal_reflectance(ior: f64) -> f64 {
    ((ior - 1.0) / (ior + 1.0)).powi(2)
}

//! glTF's parameters as albedo, reflectance and width of the lobe.

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("surface", surface)];

/// Khronos Group 2021, glTF 2.0, appendix B.2, without maps; alpha is roughness squared (Burley 2012), and at least 1e-4.
fn surface(at: &At) -> Vec<f64> {
    let (base, metalness) = (at.param_vector("base_color"), at.param("metalness"));
    let (position, normal) = (at.vector("at.position"), at.vector("at.normal"));
    let diffuse = base * (1.0 - metalness);
    let f0 = base * metalness + at.param("reflectance") * (1.0 - metalness);
    let emission = at.param_vector("emission_color") * at.param("emission");
    let mut numbers = Vec::new();
    for vector in [position, normal, normal, diffuse, f0] {
        numbers.extend(vector.to_array());
    }
    // The constant as the shader has it, in 32 bits.
    let alpha = at.param("roughness").powi(2).max(f64::from(1e-4_f32));
    numbers.push(alpha);
    // The tangent as interpolated, made orthogonal to the normal.
    let along = at.vector("at.tangent");
    let tangent = (along - normal * normal.dot(along)).normalize();
    numbers.extend(tangent.to_array());
    numbers.extend([alpha; 2]);
    numbers.extend(emission.to_array());
    numbers.push(at.param("opacity"));
    numbers
}

/// A point of a drawn surface, as interpolated.
struct Fragment {
    /// World space, m.
    position: vec3f,
    /// Unit length, world space, on the side of the viewer for double-sided objects.
    normal: vec3f,
    /// Direction of growing u in world space, of any length, zero where the mesh has none;
    /// w is the sign of the bitangent, cross(normal, tangent) * w.
    tangent: vec4f,
    uv: vec2f,
}

/// What light finds at a point.
struct Surface {
    /// World space, m.
    position: vec3f,
    /// Shading normal, unit length.
    normal: vec3f,
    /// Interpolated normal before any normal map, unit length.
    geometric_normal: vec3f,
    /// Albedo of the diffuse part, linear Rec.709 in [0, 1].
    diffuse: vec3f,
    /// Reflectance at normal incidence, linear Rec.709 in [0, 1].
    f0: vec3f,
    /// GGX width: perceptual roughness squared, in (0, 1].
    alpha: f32,
    /// Unit length, in the surface: along it an anisotropic surface has its first width.
    tangent: vec3f,
    /// Widths along the tangent and across it, each in (0, 1]. Isotropic surfaces have alpha in both.
    widths: vec2f,
    /// Emitted radiance, cd/m2 per channel.
    emission: vec3f,
    /// Coverage in [0, 1].
    opacity: f32,
}

/// The surface at a point. The neutral one is half-grey paper.
fn surface(at: Fragment) -> Surface {
    var s: Surface;
    s.position = at.position;
    s.normal = at.normal;
    s.geometric_normal = at.normal;
    s.diffuse = vec3f(0.5);
    s.f0 = vec3f(0.04);
    s.alpha = 1.0;
    s.tangent = frame_of(at.normal)[0];
    s.widths = vec2f(1.0);
    s.opacity = 1.0;
    return s;
}

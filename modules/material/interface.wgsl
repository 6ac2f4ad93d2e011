/// A point of a drawn surface, as interpolated.
struct Fragment {
    /// World space, m.
    position: vec3f,
    /// Unit length, world space, on the side of the viewer for double-sided objects.
    normal: vec3f,
    /// Direction of growing u in world space, of any length, zero where the mesh has none;
    /// w is the sign of the bitangent, cross(normal, tangent) * w. On the back of a double-sided object the tangent and the bitangent are
    /// reversed as the normal is, so that a normal map's relief is that of the front seen from behind.
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
    /// Roughness of what is matte, in [0, 1]: 0 is Lambert's law.
    diffuse_roughness: f32,
    /// Reflectance at normal incidence, linear Rec.709 in [0, 1].
    f0: vec3f,
    /// Reflectance at the horizon, linear Rec.709 in [0, 1]: 1, unless a material weakens its reflection.
    f90: vec3f,
    /// Factor of the reflectance at 82 degrees, where metals have their colour's edge, linear Rec.709 in [0, 1]: 1 is Schlick's law.
    f82: vec3f,
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
    /// Share of the surface that has a clear coat, in [0, 1].
    coat: f32,
    /// Width of the coat's lobe, in (0, 1].
    coat_alpha: f32,
    /// Index of refraction of the coat, 1 and more.
    coat_ior: f32,
    /// What is left of white light that went through the coat and back along its normal, linear Rec.709 in [0, 1].
    coat_color: vec3f,
    /// Normal of the coat, unit length.
    coat_normal: vec3f,
    /// Share of the surface that has fuzz (fibres or dust), in [0, 1].
    fuzz: f32,
    /// Albedo of the fuzz, linear Rec.709 in [0, 1].
    fuzz_color: vec3f,
    /// Roughness of the fuzz, in [0, 1]: how far its fibres point aside.
    fuzz_roughness: f32,
}

/// The surface at a point. The neutral one is half-grey paper.
fn surface(at: Fragment) -> Surface {
    var s: Surface;
    s.position = at.position;
    s.normal = at.normal;
    s.geometric_normal = at.normal;
    s.diffuse = vec3f(0.5);
    s.diffuse_roughness = 1.0;
    s.f0 = vec3f(0.04);
    s.f90 = vec3f(1.0);
    s.f82 = vec3f(1.0);
    s.alpha = 1.0;
    s.tangent = frame_of(at.normal)[0];
    s.widths = vec2f(1.0);
    s.opacity = 1.0;
    s.coat_alpha = 1.0;
    s.coat_ior = 1.5;
    s.coat_color = vec3f(1.0);
    s.coat_normal = at.normal;
    s.fuzz_color = vec3f(1.0);
    s.fuzz_roughness = 0.5;
    return s;
}

/// A surface at a point with this shading normal: black, opaque, of a single layer, its tangent along growing u. A material sets what it knows.
fn bare_surface(at: Fragment, normal: vec3f) -> Surface {
    var s: Surface;
    s.position = at.position;
    s.normal = normal;
    s.geometric_normal = at.normal;
    s.f90 = vec3f(1.0);
    s.f82 = vec3f(1.0);
    s.alpha = 1.0;
    s.tangent = tangent_at(at, normal);
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

/// Growing u made orthogonal to the normal, unit length; any direction in the surface where the mesh has none.
fn tangent_at(at: Fragment, normal: vec3f) -> vec3f {
    return unit_or(at.tangent.xyz - normal * dot(normal, at.tangent.xyz), frame_of(normal)[0]);
}

/// The tangent turned counter-clockwise about the normal, seen from outside; an angle of a quarter turn leads along growing v.
fn turned_tangent(at: Fragment, normal: vec3f, angle: f32) -> vec3f {
    let tangent = tangent_at(at, normal);
    let side = select(1.0, at.tangent.w, at.tangent.w != 0.0);
    // Of angles beyond pi WGSL promises no sine.
    let a = angle - 2.0 * PI * round(angle / (2.0 * PI));
    return tangent * cos(a) + cross(normal, tangent) * (side * sin(a));
}

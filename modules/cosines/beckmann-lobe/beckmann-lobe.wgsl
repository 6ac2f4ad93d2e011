var<storage> table: array<vec2f, 3072>;

/// As `table.rs` made it.
fn cosine_pair(k: u32) -> vec2f {
    return table[k];
}

/// Schlick's term.
fn cosine_fresnel() -> f32 {
    return 1.0;
}

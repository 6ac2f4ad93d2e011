/// Rows and columns of a table. Rows: roughness, the root of alpha, from 0 to 1. Columns: the root of m (1 + alpha) / (m + alpha), m the cosine of
/// the angle of incidence, from 0 to 1.
const COSINE_SIDE: u32 = 32u;

/// Numbers of the table, two by two, three pairs a cell: of the inverse map those in row 0 and columns 0 and 2, then of row 2 the same, then the lobe's
/// integral A with F = 1, and what that with Schlick's F for f0 = 0 is above `cosine_fresnel` times A (1 - m)^5. What the map's numbers are divided by is told in `modules/src/oracles/cosines.rs`.
/// Neutral: a lobe that holds nothing.
fn cosine_pair(k: u32) -> vec2f {
    return vec2f(0.0);
}

/// 1 where the lobe has Schlick's Fresnel term (1994, eq. 15), 0 where it has none.
fn cosine_fresnel() -> f32 {
    return 1.0;
}

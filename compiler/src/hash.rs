//! temp
/// temp
pub fn structural_hash(_: &naga::Module) -> u128 { 0 }

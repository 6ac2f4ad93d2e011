//! What the build script wrote: a module for each pass.

/// The module of this name, from the build script.
macro_rules! shaders {
    ($($name:literal),*) => { $(include!(concat!(env!("OUT_DIR"), "/", $name, ".rs"));)* };
}

shaders!("matte", "glossy");
// The renderer does without these; its tests run them.
shaders!(
    "auto_exposure",
    "corners",
    "depth",
    "display",
    "double_sided",
    "forward",
    "unshadowed"
);

//! Scenes that come with the explorer.

/// A scene with its name and text.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// Its name, by which a link or the command line asks for it.
    pub name: &'static str,
    /// One line.
    pub summary: &'static str,
    /// RON.
    pub text: &'static str,
}

macro_rules! example {
    ($name:literal, $summary:literal) => {
        Example {
            name: $name,
            summary: $summary,
            text: include_str!(concat!("../../scenes/", $name, ".scene.ron")),
        }
    };
}

/// All of them; the first is opened where nothing else is asked for.
pub const ALL: &[Example] = &[
    example!("first", "A copper teapot among glazed and painted things"),
    example!("sphere", "One sphere under a few lights"),
    example!("materials", "A sphere for each kind of material"),
    example!("area", "A glossy floor under one area light of each shape"),
    example!("spots", "Downlights, a wall washer and spots, from photometric files"),
    example!("sun", "Spheres in the sun"),
    example!("screen", "A picture that shines on a floor"),
];

/// The example of this name.
pub fn find(name: &str) -> Option<&'static Example> {
    ALL.iter().find(|example| example.name == name)
}

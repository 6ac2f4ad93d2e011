//! Places for the modules of a recipe: the root above, what fills a slot below, equal subtrees once.

use indexmap::IndexMap;
use shadewright_compiler::Program;

/// A module instance in the drawing.
#[derive(Clone, Debug)]
pub struct Node {
    /// Module's name.
    pub module: String,
    /// Its category.
    pub category: String,
    /// Slots that it stands in, each once.
    pub slots: Vec<String>,
    /// Slot paths where it stands.
    pub places: Vec<String>,
    /// Whether anything of it is in the shader.
    pub is_reached: bool,
    /// Middle of its box.
    pub x: f32,
    /// Top of its box.
    pub y: f32,
    /// Width of its box.
    pub width: f32,
    /// How deep it stands at most.
    depth: usize,
    /// What fills its slots, in order, each instance once.
    pub below: Vec<usize>,
    /// It is one of several leaves that stand below each other: a line reaches it from the left.
    pub is_stacked: bool,
}

impl Node {
    /// What its box says before the module's name.
    pub fn slot(&self) -> String {
        self.slots.join(", ")
    }
}

/// The drawing.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// Parents before what is below them.
    pub nodes: Vec<Node>,
    /// From the upper left corner.
    pub size: [f32; 2],
}

/// Height of a box.
pub const HEIGHT: f32 = 24.0;
/// From a box to the next one beside it.
const GAP: f32 = 18.0;
/// From the top of a box to the top of those below it.
const LEVEL: f32 = 58.0;
/// From leaf to leaf of a stack.
const PITCH: f32 = 29.0;
/// Leaves in a stack.
const STACK: usize = 4;
/// Room for the line on the left of a stack.
const RAIL: f32 = 10.0;

/// Places the instances of a program; `width` measures the text of a box.
pub fn layout(program: &Program, width: impl Fn(&str) -> f32) -> Drawing {
    let reflection = program.reflection();
    let mut nodes: IndexMap<String, Node> = IndexMap::new();
    let mut by_place: IndexMap<String, usize> = IndexMap::new();
    for line in program.tree() {
        let above = line.path.rsplit_once('.').map(|(above, _)| above);
        let slot = above.map_or(String::new(), |above| line.path[above.len() + 1..].to_owned());
        let (index, _) = nodes.insert_full(
            line.instance.to_owned(),
            nodes.get(line.instance).cloned().unwrap_or_else(|| Node {
                module: line.module.to_owned(),
                category: line.category.to_owned(),
                slots: Vec::new(),
                places: Vec::new(),
                is_reached: reflection.functions.iter().any(|f| f.instance.as_deref() == Some(line.instance)),
                x: 0.0,
                y: 0.0,
                width: 0.0,
                depth: 0,
                below: Vec::new(),
                is_stacked: false,
            }),
        );
        let node = &mut nodes[index];
        node.depth = node.depth.max(line.path.matches('.').count());
        node.places.push(line.path.clone());
        if !slot.is_empty() && !node.slots.contains(&slot) {
            node.slots.push(slot);
        }
        if let Some(&above) = above.and_then(|above| by_place.get(above))
            && !nodes[above].below.contains(&index)
        {
            nodes[above].below.push(index);
        }
        by_place.insert(line.path, index);
    }
    let mut nodes: Vec<Node> = nodes.into_values().collect();
    for node in &mut nodes {
        let count = if node.places.len() > 1 {
            format!("  x{}", node.places.len())
        } else {
            String::new()
        };
        node.width = width(&format!("{} {}{count}", node.slot(), node.module)) + 20.0;
    }
    let mut placer = Placer {
        placed: vec![false; nodes.len()],
        nodes,
        right: 0.0,
    };
    if !placer.nodes.is_empty() {
        placer.place(0);
    }
    let nodes = placer.nodes;
    let bottom = nodes.iter().map(|node| node.y + HEIGHT).fold(0.0, f32::max);
    let right = nodes.iter().map(|node| node.x + node.width / 2.0).fold(0.0, f32::max);
    Drawing {
        nodes,
        size: [right, bottom],
    }
}

struct Placer {
    nodes: Vec<Node>,
    placed: Vec<bool>,
    /// Left of this is taken.
    right: f32,
}

impl Placer {
    /// Places a box above the boxes below it that have no place yet.
    fn place(&mut self, index: usize) {
        self.placed[index] = true;
        self.nodes[index].y = self.nodes[index].depth as f32 * LEVEL;
        let left = self.right;
        let below: Vec<usize> = self.nodes[index].below.iter().copied().filter(|&b| !self.placed[b]).collect();
        let (leaves, trees): (Vec<usize>, Vec<usize>) = below.iter().partition(|&&b| self.nodes[b].below.is_empty());
        for tree in trees {
            // What is shared may have got its place within the tree before.
            if !self.placed[tree] {
                self.place(tree);
            }
        }
        let columns = leaves.len().div_ceil(STACK).max(1);
        let leaves: Vec<usize> = leaves.into_iter().filter(|&leaf| !self.placed[leaf]).collect();
        for stack in leaves.chunks(leaves.len().div_ceil(columns).max(1)) {
            self.stack(stack);
        }
        let own = self.nodes[index].width;
        let children = below.iter().map(|&b| self.nodes[b].x);
        let (first, last) = children.fold((f32::MAX, f32::MIN), |(first, last), x| (first.min(x), last.max(x)));
        let middle = if below.is_empty() { left + own / 2.0 } else { (first + last) / 2.0 };
        let x = middle.max(left + own / 2.0);
        self.nodes[index].x = x;
        self.right = self.right.max(x + own / 2.0 + GAP);
    }

    /// Places leaves below each other.
    fn stack(&mut self, leaves: &[usize]) {
        let widest = leaves.iter().map(|&leaf| self.nodes[leaf].width).fold(0.0, f32::max);
        let is_stacked = leaves.len() > 1;
        let left = self.right + if is_stacked { RAIL } else { 0.0 };
        for (number, &leaf) in leaves.iter().enumerate() {
            self.placed[leaf] = true;
            let node = &mut self.nodes[leaf];
            node.x = left + node.width / 2.0;
            node.y = node.depth as f32 * LEVEL + number as f32 * PITCH;
            node.is_stacked = is_stacked;
        }
        self.right = left + widest + GAP;
    }
}

#[cfg(test)]
mod tests {
    use shadewright_compiler::{Catalog, Recipe};

    use super::*;

    /// Catches boxes on top of each other, a box above what holds it, and an equal subtree that is drawn twice.
    #[test]
    fn boxes_do_not_overlap() {
        let catalog = Catalog::load(shadewright_modules::library()).unwrap();
        let text = r#"(module: "forward", fill: {
            "material": "metalness", "brdf": "microfacet",
            "lights": [(module: "point", fill: {"visibility": "cube-map"}), (module: "spot", fill: {"visibility": "cube-map"}), "sun"],
        })"#;
        let recipe = Recipe::parse("test", text).unwrap();
        let program = catalog.compile(&recipe, "main").unwrap_or_else(|report| panic!("{report}"));
        let drawing = layout(&program, |text| text.len() as f32 * 7.0);
        assert_eq!(drawing.nodes.len(), program.reflection().instances.len());
        let shared: Vec<&Node> = drawing.nodes.iter().filter(|node| node.places.len() > 1).collect();
        assert!(shared.iter().any(|node| node.module == "frostbite"), "{shared:?}");
        for (index, a) in drawing.nodes.iter().enumerate() {
            assert!(a.below.iter().all(|&b| drawing.nodes[b].y >= a.y + LEVEL), "{a:?}");
            assert!(a.x - a.width / 2.0 >= 0.0 && a.x + a.width / 2.0 <= drawing.size[0]);
            for b in &drawing.nodes[index + 1..] {
                let apart = (a.x - b.x).abs() >= (a.width + b.width) / 2.0 || (a.y - b.y).abs() >= HEIGHT;
                assert!(apart, "{a:?} and {b:?}");
            }
        }
    }
}

//! The compiler's product: one pass, linked, validated and reflected.

use std::sync::{Arc, OnceLock};

use crate::catalog::{Catalog, Module};
use crate::diagnostics::{Diagnostic, Report, SourceFile, codes};
use crate::hash::structural_hash;
use crate::link::{link, write_source, write_traced};
use crate::manifest::{Node, PassDecl, parse_recipe};
use crate::origins;
use crate::plan::{Plan, Roots, plan, roomy};
use crate::reflect::{Reflection, reflect};
use crate::resolve::{Instances, Place, Tree, resolve, resolve_root};
use crate::validate::{Validated, located, validate};
use crate::why;

pub use crate::origins::{ItemOrigin, LineOrigin};
pub use crate::why::Why;

/// One pass of a recipe, linked.
#[derive(Debug)]
pub struct Program {
    validated: Validated,
    reflection: OnceLock<Reflection>,
    hash: OnceLock<u128>,
    plan: Plan,
    pass: String,
    /// Modules of the recipe's own tree, where that declares this pass and is not linked for it.
    declaring: Vec<Arc<Module>>,
    wgsl: OnceLock<String>,
}

impl Program {
    /// The validated module.
    pub fn validated(&self) -> &Validated {
        &self.validated
    }

    /// What a host must know to run it. Found out when first asked for.
    pub fn reflection(&self) -> &Reflection {
        self.reflection
            .get_or_init(|| reflect(&self.plan, &self.validated, self.hash(), &self.pass))
    }

    /// Hash of the canonical IR: equal for programs that mean the same up to names. Found out when first asked for.
    pub fn hash(&self) -> u128 {
        *self.hash.get_or_init(|| structural_hash(self.validated.module()))
    }

    /// The source form: the authors' own text, linked. Written when first asked for.
    pub fn wgsl(&self) -> &str {
        self.wgsl.get_or_init(|| write_source(&self.plan))
    }

    /// Why a function, binding, parameter, override, struct or constant is there; empty if it is not.
    pub fn why(&self, name: &str) -> Vec<Why> {
        why::why(&self.plan, self.reflection(), self.wgsl(), name)
    }

    /// Where the lines of the source form come from, one for each line: `None` for lines between items. Written anew with every call.
    pub fn origins(&self) -> Vec<Option<LineOrigin>> {
        let found = roomy(self.plan.deep, || {
            let (text, sections) = write_traced(&self.plan);
            origins::origins(&self.plan, &text, &sections)
        });
        // Without a thread for a plan that wants a large stack nothing is known.
        found.unwrap_or_default()
    }

    /// The tree, and the node in it that an instance stands for first.
    pub(crate) fn node_of(&self, instance: &str) -> Option<(&Tree, usize)> {
        let found = self.plan.instances.list.iter().find(|i| i.name == instance)?;
        Some((&self.plan.tree, found.node))
    }

    /// Whether a catalog would compile the recipe to this program again: no edit between the catalogs touches what it is made of.
    pub fn is_current(&self, catalog: &Catalog) -> bool {
        // A module whose interfaces are edited is not kept either.
        let linked = self.plan.tree.nodes.iter().map(|node| &node.module);
        linked.chain(&self.declaring).all(|module| catalog.has_module(module))
    }

    /// The tree of the recipe as it was resolved, defaults included: a line a module with its slot path.
    pub fn tree(&self) -> impl Iterator<Item = TreeLine<'_>> {
        self.plan.tree.nodes.iter().enumerate().map(|(index, node)| TreeLine {
            path: self.plan.tree.path(index),
            module: &node.module.name,
            category: &node.module.category,
            instance: &self.plan.instances.list[self.plan.instances.of_node[index]].name,
            because: self.plan.tree.place(index).text(),
        })
    }
}

/// A module in its place in a resolved tree.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct TreeLine<'p> {
    /// Slot path: `main`, `main.brdf.ndf`, `main.lights[1]`.
    pub path: String,
    /// Module.
    pub module: &'p str,
    /// Its category.
    pub category: &'p str,
    /// Instance; equal subtrees share theirs.
    pub instance: &'p str,
    /// `file:line:column` of the text that put it there.
    pub because: String,
}

/// A recipe with the text it came from, so that errors can point into it.
#[derive(Clone, Debug)]
pub struct Recipe {
    /// The tree.
    pub root: Node,
    /// The text it was read from; made up by serialising where it was built by a program.
    pub source: Arc<SourceFile>,
}

impl Recipe {
    /// Reads a recipe: the text of a `*.recipe.ron` file, an inline RON tree, or a module's name alone.
    ///
    /// # Errors
    /// The text is no RON, or no recipe.
    pub fn parse(name: &str, text: &str) -> Result<Self, Report> {
        let parsed = parse_recipe(name, text)?;
        Ok(Self {
            root: parsed.value,
            source: parsed.file,
        })
    }
}

impl From<Node> for Recipe {
    fn from(root: Node) -> Self {
        // A tree of strings, numbers and lists always serialises.
        let text = ron::to_string(&root).unwrap_or_default();
        Self {
            root,
            source: SourceFile::new("recipe", text),
        }
    }
}

impl Catalog {
    /// Links and validates one pass of a recipe: `main` for the root's own entry points, `<instance>.<pass>` for a pass that a module of the
    /// tree declares. Hash, reflection and source form are made when the program is first asked for them.
    ///
    /// # Errors
    /// Anything wrong with the recipe or with the modules it reaches.
    pub fn compile(&self, recipe: &Recipe, pass: &str) -> Result<Program, Report> {
        self.finish(self.plan(recipe, pass)?)
    }

    /// The root's own pass, and behind it every pass that must run before it, in their order.
    ///
    /// # Errors
    /// As for [`Catalog::compile`].
    pub fn compile_all(&self, recipe: &Recipe) -> Result<Vec<Program>, Report> {
        let main = self.compile(recipe, "main")?;
        let before: Vec<String> = main
            .reflection()
            .passes
            .iter()
            .map(|pass| format!("{}.{}", pass.instance, pass.name))
            .collect();
        let mut all = vec![main];
        for pass in before {
            all.push(self.compile(recipe, &pass)?);
        }
        Ok(all)
    }

    /// The first half of [`Catalog::compile`]: everything that can be known before anything is written.
    ///
    /// # Errors
    /// Anything wrong with the recipe or with the modules it reaches.
    pub fn plan(&self, recipe: &Recipe, pass: &str) -> Result<LinkPlan, Report> {
        let tree = resolve(self, recipe)?;
        let instances = Instances::find(self, &tree);
        if pass == "main" {
            return self.plan_tree(tree, instances, &Roots::Main, pass);
        }
        let found = pass.rsplit_once('.').and_then(|(name, own)| {
            let instance = instances.list.iter().position(|i| i.name == name)?;
            let node = &tree.nodes[instances.list[instance].node];
            Some((instance, own, node.module.manifest.passes.get(own)?))
        });
        match found {
            Some((instance, _, PassDecl::Compute { entry, .. })) => {
                let roots = Roots::Entry {
                    instance,
                    entry: entry.clone(),
                };
                self.plan_tree(tree, instances, &roots, pass)
            }
            Some((instance, own, PassDecl::Draw { root, inherit, .. })) => {
                let node = &tree.nodes[instances.list[instance].node];
                let mut root = root.clone();
                for slot in inherit {
                    // What stands there, whether the recipe says so or the root's manifest.
                    let declared = tree.nodes[0].module.manifest.slots.get(slot);
                    let filling = recipe.root.fill.get(slot).or_else(|| declared?.default.as_ref());
                    if let Some(filling) = filling {
                        root.fill.insert(slot.clone(), filling.clone());
                    }
                }
                let place = Place::new(&node.module.source).keys(&["passes", own, "root"]);
                let module = self.module_at(&root.module, None, || place.clone())?;
                let declaring = tree.nodes.iter().map(|node| Arc::clone(&node.module)).collect();
                let tree = resolve_root(self, module, &root, place)?;
                let instances = Instances::find(self, &tree);
                let plan = self.plan_tree(tree, instances, &Roots::Main, pass)?;
                Ok(LinkPlan { declaring, ..plan })
            }
            None => {
                let mut known = vec!["main".to_owned()];
                for instance in &instances.list {
                    let passes = &tree.nodes[instance.node].module.manifest.passes;
                    known.extend(passes.keys().map(|p| format!("{}.{p}", instance.name)));
                }
                let diagnostic = Diagnostic::new(codes::UNKNOWN_PASS_OF_RECIPE, format!("the recipe has no pass `{pass}`"));
                let diagnostic = diagnostic.at(&recipe.source, Place::new(&recipe.source).name_span(), "in the tree of this root");
                Err(diagnostic.suggest(pass, "passes", known.iter().map(String::as_str)).into())
            }
        }
    }

    pub(crate) fn plan_tree(&self, tree: Tree, instances: Instances, roots: &Roots, pass: &str) -> Result<LinkPlan, Report> {
        let plan = plan(self, tree, instances, roots)?;
        Ok(LinkPlan {
            plan,
            pass: pass.to_owned(),
            declaring: Vec::new(),
        })
    }

    /// The second half of [`Catalog::compile`]: writes the plan as IR and validates it. Nothing is reflected yet; hash and source form are
    /// made here only for plans with deeply nested functions, which want a large stack.
    ///
    /// # Errors
    /// The linked module does not pass naga's validator.
    pub fn finish(&self, plan: LinkPlan) -> Result<Program, Report> {
        let LinkPlan { plan, pass, declaring } = plan;
        roomy(plan.deep, move || {
            let module = link(&plan);
            let validated = match validate(module) {
                Ok(validated) => validated,
                // The module is gone with the error: writing it again is for failures only.
                Err(error) => return Err(located(&plan, &link(&plan), &error)),
            };
            let (hash, wgsl) = if plan.deep {
                // While there is room for it.
                (structural_hash(validated.module()).into(), write_source(&plan).into())
            } else {
                (OnceLock::new(), OnceLock::new())
            };
            Ok(Program {
                validated,
                reflection: OnceLock::new(),
                hash,
                plan,
                pass,
                declaring,
                wgsl,
            })
        })?
    }
}

/// What a pass will hold, under which names and bindings: the common ground of both written forms.
#[derive(Debug)]
pub struct LinkPlan {
    plan: Plan,
    pass: String,
    declaring: Vec<Arc<Module>>,
}

impl LinkPlan {
    /// Writes the plan as IR, which nobody has validated yet.
    ///
    /// # Errors
    /// There is no thread for a plan that wants a large stack.
    pub fn link(&self) -> Result<naga::Module, Report> {
        Ok(roomy(self.plan.deep, || link(&self.plan))?)
    }

    /// Writes the plan as source.
    ///
    /// # Errors
    /// As for [`LinkPlan::link`].
    pub fn source(&self) -> Result<String, Report> {
        Ok(roomy(self.plan.deep, || write_source(&self.plan))?)
    }
}

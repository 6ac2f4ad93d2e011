//! What keeps a program from being evaluated.

/// Errors of the evaluator.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EvaluateError {
    /// The module has no such entry point.
    #[error("there is no entry point `{0}`")]
    NoEntryPoint(String),
    /// The evaluation came to something that only a GPU does, or that this evaluator does not do.
    #[error("{0} cannot be evaluated on the CPU")]
    Unsupported(String),
    /// Variables and buffers that are too large altogether.
    #[error("{what} has more than {limit} numbers")]
    TooLarge {
        /// What is too large.
        what: String,
        /// How many numbers are taken.
        limit: usize,
    },
    /// The evaluation did not end.
    #[error("the evaluation did not end in {limit} steps")]
    Steps {
        /// How many steps were taken.
        limit: u64,
    },
    /// Nothing in the program has this binding.
    #[error("the program has no binding {binding} in group {group}")]
    NoBinding {
        /// Bind group.
        group: u32,
        /// Binding in the group.
        binding: u32,
    },
    /// Another kind of resource belongs there.
    #[error("`{name}` is no {given}")]
    OtherResource {
        /// Name of the variable.
        name: String,
        /// What was given: buffer, texture, sampler.
        given: &'static str,
    },
    /// A buffer that is too short for its type.
    #[error("`{name}` needs {needed} bytes, its buffer has {found}")]
    BufferSize {
        /// Name of the variable.
        name: String,
        /// Fewest bytes that the type takes.
        needed: u64,
        /// Bytes given.
        found: u64,
    },
    /// A texture whose size and texels do not fit together.
    #[error("a texture of {width} x {height} texels in {layers} layers needs {needed} numbers for its levels, found {found}")]
    TextureSize {
        /// Width of the first level.
        width: u32,
        /// Height of the first level.
        height: u32,
        /// Layers.
        layers: u32,
        /// Numbers that it needs.
        needed: u64,
        /// Numbers given.
        found: u64,
    },
    /// A pipeline constant that the program does not have.
    #[error("the program has no override `{0}`")]
    NoOverride(String),
    /// A pipeline constant without a value, or with one that it cannot hold.
    #[error("override `{name}`: {why}")]
    Override {
        /// Name or number of the override.
        name: String,
        /// What is wrong.
        why: String,
    },
}

/// Shorthand for what can't be evaluated.
pub(crate) fn unsupported(what: impl Into<String>) -> EvaluateError {
    EvaluateError::Unsupported(what.into())
}

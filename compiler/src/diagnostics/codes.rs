//! Every code that a diagnostic can carry. The table of `spec/diagnostics.md` is checked against this one.

macro_rules! codes {
    ($($(#[$group:meta])* $name:ident = $code:literal, $meaning:literal;)*) => {
        $(
            #[doc = $meaning]
            pub const $name: &str = $code;
        )*

        /// All codes with their meaning in one line, in ascending order.
        pub const ALL: &[(&str, &str)] = &[$(($code, $meaning)),*];
    };
}

codes! {
    RON_SYNTAX = "SW0101", "The text is not RON.";
    UNKNOWN_FIELD = "SW0102", "A field, or a variant's field, that does not exist.";
    WRONG_SHAPE = "SW0103", "A field is missing, or its value has another type than the one expected.";
    UNKNOWN_VARIANT = "SW0104", "A word that is none of the choices of its place.";
    DUPLICATE_KEY = "SW0105", "A field or a map's key stands twice.";
    BAD_NAME = "SW0106", "A name that WGSL does not take as an identifier, or that it reserves.";
    BAD_DEFAULT = "SW0107", "A parameter's default is not of its type, or not in its range.";
    BAD_RANGE = "SW0108", "A range whose lower end is not below its upper end, or that is not finite.";
    BAD_MODE = "SW0109", "A parameter's type cannot reach the shader in this mode.";
    UNKNOWN_PASS = "SW0110", "A resource is made from a pass that the module does not declare as `Draw`.";
    BAD_RESOLUTION = "SW0111", "A pass takes its resolution from a parameter that does not exist or is no `U32`.";
    NAME_CLASH = "SW0112", "Two declarations of one module share a name.";
    BAD_UNIT = "SW0113", "A conversion factor of `also` is not a positive finite number, or names the unit itself.";
    UNKNOWN_CAPABILITY = "SW0114", "A capability that naga does not know.";
    UNKNOWN_INTERFACE = "SW0115", "An interface that is no category of the library.";
    BAD_GROUP = "SW0116", "A bind group other than 0, 1, 2 and 3.";
    UNKNOWN_FUNCTION = "SW0117", "A category names a function that its interface does not have.";
    BAD_INTERFACE_DEFAULT = "SW0118", "A category gives a default to a struct or member that its interface does not have, or of another type.";
    BAD_DISPATCH = "SW0119", "A compute pass names no compute entry point of its module.";
    BAD_DATA_KIND = "SW0120", "A resource of kind `Data` that says neither file nor format, whose file is not in the module's folder, or that is a category's.";

    UNKNOWN_MODULE = "SW0201", "A module that the library does not have.";
    WRONG_CATEGORY = "SW0202", "A module of another category than its slot takes.";
    MISSING_FILLING = "SW0203", "A slot without default that the recipe does not fill.";
    UNKNOWN_SLOT = "SW0204", "A slot that the module does not have.";
    CYCLIC_TREE = "SW0205", "A tree that contains itself, through defaults.";
    RULE_BROKEN = "SW0206", "A module's rule about the rest of the tree is broken.";
    TOO_MANY_FILLINGS = "SW0207", "More modules than the slot takes.";
    AMBIGUOUS_NAME = "SW0208", "A name that modules of several categories have.";
    BAD_LABEL = "SW0209", "Two different subtrees have one label, or the label is no identifier.";
    NOT_COMBINABLE = "SW0210", "A list slot's interface has a function without a rule by which results are combined.";
    NOT_A_ROOT = "SW0211", "The recipe's root has no entry points, or is asked for a pass that it does not have.";
    UNKNOWN_PASS_OF_RECIPE = "SW0212", "No module of the recipe declares a pass of this name.";
    UNKNOWN_PROBE = "SW0213", "The root's interface has no function of this name.";
    UNKNOWN_FILE = "SW0214", "A recipe names a file for something that takes none.";
    MISSING_FILE = "SW0215", "A module's data that are in no file: the recipe must name one.";

    UNKNOWN_PARAM = "SW0301", "A parameter that the module does not have.";
    PARAM_OUT_OF_RANGE = "SW0302", "A parameter's value is outside its range.";
    PARAM_WRONG_TYPE = "SW0303", "A parameter's value has another type than the parameter.";
    UNKNOWN_UNIT = "SW0304", "A quantity in a unit that the parameter does not take.";
    PARAM_NOT_FINITE = "SW0305", "A parameter's value is infinite or not a number.";
    BAD_TEMPERATURE = "SW0306", "A colour temperature outside 1000 to 40000 kelvin, or of daylight outside 4000 to 25000.";
    INSTANCE_FIELD_FROZEN = "SW0307", "A recipe freezes a field of `instances`, which only a scene can set.";

    WGSL_SYNTAX = "SW0401", "A module's or interface's WGSL cannot be parsed.";
    WGSL_TYPE = "SW0402", "A module's or interface's WGSL is refused by the type checker or validator.";
    DUPLICATE_SYMBOL = "SW0403", "A module declares a name that an interface it uses declares already.";
    SIGNATURE_MISMATCH = "SW0404", "A function has another signature than its interface says.";
    MISSING_FUNCTION = "SW0405", "A module does not define a function of its interface, or one that its slot's interface expects from it.";
    UNTYPED_CONSTANT = "SW0406", "A constant of an interface without a type, which would vanish when it is parsed.";
    RECURSION = "SW0407", "Functions of several modules call each other in a circle.";
    UNDECLARED_RESOURCE = "SW0408", "A resource that stands in the WGSL or in the manifest, but not in both.";
    PARAMS_MISUSED = "SW0409", "`params` or `instances` is used otherwise than by member or element.";
    EXPLICIT_BINDING = "SW0410", "A module gives `@group` or `@binding` itself; the linker numbers bindings.";
    ENTRY_POINT_IO = "SW0411", "An entry point takes or gives locations outside a struct.";
    MISSING_WGSL = "SW0412", "A module's or interface's WGSL file is not there.";
    RESERVED_NAME = "SW0413", "A module declares a name that the linker generates.";
    NOT_LINKABLE = "SW0415", "A module uses ray tracing, cooperative matrices or mesh stages, which the linker does not take.";
    WESL_SYNTAX = "SW0416", "A module's or an imported file's WESL cannot be parsed.";
    WESL_IMPORT = "SW0417", "An import of WESL that leads nowhere, or in a way that is not taken.";
    WESL_CONDITION = "SW0418", "A condition of WESL that is malformed, or that asks for a feature which is not declared.";
    WESL_DECLARATION = "SW0419", "A `wesl.ron` that is no RON, or says something unknown.";
    WESL_AND_WGSL = "SW0420", "A module with both a WESL and a WGSL file.";
    BAD_DATA_TYPE = "SW0421", "A resource of kind `Data` that is no read-only storage buffer with an array of floats without gaps.";

    LINKED_INVALID = "SW0501", "The linked module does not pass validation.";
    CAPABILITY_UNDECLARED = "SW0502", "A module uses a capability that its manifest does not declare.";
    WRONG_STAGE = "SW0503", "A module uses something that the stage of its tree does not have, such as derivatives outside fragments.";

    UNSUPPORTED_BY_TARGET = "SW0601", "The target language lacks something that the shader needs.";
    BACKEND_FAILURE = "SW0602", "naga's writer for the target failed.";
    UNKNOWN_ENTRY_POINT = "SW0603", "The shader has no such entry point, or one must be named.";

    FILE_TOO_LARGE = "SW0701", "A text larger than the limit.";
    NESTING_TOO_DEEP = "SW0702", "Brackets nested deeper than the limit.";
    TREE_TOO_DEEP = "SW0703", "A recipe's tree deeper than the limit.";
    TOO_MANY_INSTANCES = "SW0704", "More module instances than the limit.";
    UPSTREAM_PANIC = "SW0705", "naga gave up with an internal error.";
    LIST_TOO_LONG = "SW0706", "A list longer than the limit.";
    WESL_PANIC = "SW0707", "wesl gave up with an internal error.";

    MISSING_CATEGORY = "SW0801", "A folder of modules without `category.ron`.";
    MISSING_MANIFEST = "SW0802", "A module's folder without `module.ron`.";
    MISSING_INTERFACE = "SW0803", "A category without `interface.wgsl`.";
    UNREADABLE_FILE = "SW0804", "A file that is there but cannot be read.";
    MISSING_DATA = "SW0805", "A file of numbers that a manifest names is not there.";
    BAD_DATA = "SW0806", "A file of numbers that is cut off, holds what is no finite number, or has not as many as its buffer takes.";

    SCENE_INVALID = "SW0901", "A scene says something that cannot be.";
    UNKNOWN_SCENE_NAME = "SW0902", "A scene refers to a name that it does not declare.";
    ASSET_UNREADABLE = "SW0903", "A file that a scene names is missing or damaged.";
    ASSET_UNSUPPORTED = "SW0904", "A file that a scene names uses something that is not taken.";
    BAD_INPUT_TABLE = "SW0905", "A table of inputs does not fit the function's arguments.";
    BAD_OVERRIDE_PATH = "SW0906", "A `--set` path that leads nowhere in the scene.";
    BAD_DATA_FILE = "SW0907", "A file of data that a recipe or scene names is missing, damaged, or does not fill its buffer.";
    UNKNOWN_FORMAT = "SW0908", "A format of data that no decoder reads.";

    BAD_CHOICE = "SW1001", "A choice that offers nothing, or whose bounds contradict one another or what it offers.";
    BAD_VALUES = "SW1002", "A list or range of values that holds none, or too many, or whose ends or steps contradict one another.";
    UNKNOWN_TAG = "SW1003", "A rule of a space names a tag that neither the library nor the space has.";
    SPACE_TOO_LARGE = "SW1004", "A space with more alternatives than the limit.";
    SPACE_TOO_TANGLED = "SW1005", "A space whose rules tie together too much to be counted.";
    SPACE_UNCOUNTABLE = "SW1006", "A space with too many permutations to be numbered, or to be drawn at once.";
    SPACE_EMPTY = "SW1007", "A space without a legal permutation.";

    EXPERIMENT_INVALID = "SW1101", "An experiment says something that cannot be.";
    BAD_INPUT_RANGE = "SW1102", "An input of an experiment whose range holds nothing, is not finite, or refers to an input that is not drawn before.";
    UNKNOWN_TRUTH = "SW1103", "An experiment asks for the closed form of a folder that has none for the function.";
    BASELINE_INVALID = "SW1104", "A baseline of errors and costs that cannot be read, or is of another form.";
    FIT_INVALID = "SW1105", "A fit says something that cannot be, or a model that cannot be fitted was asked for.";
    MEASURED_DAMAGED = "SW1106", "A file of measured reflectance that is damaged, or holds nothing to compare with.";
}

#[cfg(test)]
mod tests {
    use super::ALL;

    /// Catches a code given twice, or one that was put into the wrong place of the table.
    #[test]
    fn codes_ascend_and_have_the_right_form() {
        for pair in ALL.windows(2) {
            assert!(pair[0].0 < pair[1].0, "{} before {}", pair[0].0, pair[1].0);
        }
        for (code, meaning) in ALL {
            assert!(
                code.len() == 6 && code.starts_with("SW") && code[2..].bytes().all(|b| b.is_ascii_digit()),
                "{code}"
            );
            assert!(
                meaning.ends_with('.') && !meaning.contains('|') && !meaning.contains('\n'),
                "{code}"
            );
        }
    }

    /// Catches a code that is added, changed or removed without its line in the specification.
    #[test]
    fn the_specification_lists_exactly_these_codes() {
        let spec = include_str!("../../../spec/diagnostics.md");
        let rows: Vec<&str> = spec.lines().filter(|line| line.starts_with("| SW")).collect();
        let expected: Vec<String> = ALL.iter().map(|(code, meaning)| format!("| {code} | {meaning} |")).collect();
        assert_eq!(rows, expected);
    }
}

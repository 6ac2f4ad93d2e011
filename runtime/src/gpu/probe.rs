//! Evaluates one function of a recipe on the GPU over a table of inputs.
//!
//! The compiler makes a compute program that calls the function once for each row; here the rows become bytes and
//! the results JSON again. A row is an object with one member for each argument, and may have `"params"` and `"instances"`.

use indexmap::IndexMap;
use serde_json::{Map, Value as Json, json};
use shadewright_compiler::catalog::Catalog;
use shadewright_compiler::manifest::{Param, ResourceKind, Value};
use shadewright_compiler::program::{Program, Recipe};
use shadewright_compiler::reflect::{Binding, BindingType, Fill, Layout, ParamPlace, ParamUse, Reflection};

use super::layout::GROUPS;
use super::pack::{Defaults, pack, size_with, unknown, unpack};
use super::pipeline::Pipelines;
use super::resources::{Bound, bind_group, constants, instance_rows, param_blocks, sampler, stand_in};
use super::{DataError, Gpu, GpuError, RuntimeError};

/// Bind group of the table, and the host resources that its two buffers are, as the compiler makes them.
/// Their bindings depend on what else is in the group.
const TABLE: (u32, &str, &str) = (3, "probe_input", "probe_output");
/// Most rows of one dispatch, so that a chunk's buffers stay small beside what the device has.
const MOST_ROWS: u64 = 1 << 18;

/// Evaluates a function of the recipe's root: `{"function", "device", "results"}`, the results in the order of the rows.
///
/// Struct members that a row leaves out have the interface's default, else zero; textures are white and host buffers zero;
/// a module with instances has one, with its defaults, unless the row lists some.
///
/// # Errors
/// The recipe or the function is wrong, a row does not fit the function, or the GPU fails.
pub fn probe(gpu: &Gpu, catalog: &Catalog, recipe: &Recipe, function: &str, inputs: &[Json]) -> Result<Json, RuntimeError> {
    let program = catalog.compile_probe(recipe, function)?;
    let names = Names::of(catalog, program.reflection());
    let results = evaluate(&Pipelines::new(gpu, None), gpu, &program, &names, inputs)?;
    Ok(json!({"function": function, "device": gpu.name(), "results": results}))
}

/// What a table may name beyond what reached the shader.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// Defaults of struct members.
    pub defaults: Defaults,
    /// Instance and name of parameters that the modules declare but the function does not read.
    pub unread: Vec<(String, String)>,
}

impl Names {
    /// All that the categories and the program's modules declare.
    pub fn of(catalog: &Catalog, reflection: &Reflection) -> Self {
        let mut names = Self::default();
        for category in catalog.categories() {
            for (of, members) in &category.manifest.defaults {
                names.defaults.entry(of.clone()).or_default().extend(members.clone());
            }
        }
        for instance in &reflection.instances {
            let Ok(module) = catalog.module(&format!("{}/{}", instance.category, instance.module)) else {
                continue;
            };
            for name in module.manifest.params.keys() {
                if !reflection.params.iter().any(|p| p.instance == instance.name && p.name == *name) {
                    names.unread.push((instance.name.clone(), name.clone()));
                }
            }
        }
        names
    }
}

/// Rows that share parameters and instances, and so a pipeline and its bindings.
#[derive(Debug, Default)]
struct Batch {
    params: IndexMap<String, Value>,
    instances: Json,
    rows: Vec<usize>,
}

/// Runs a probe program over the rows.
///
/// # Errors
/// A row does not fit, or the GPU fails.
pub fn evaluate(pipelines: &Pipelines, gpu: &Gpu, program: &Program, names: &Names, inputs: &[Json]) -> Result<Vec<Json>, RuntimeError> {
    let reflection = program.reflection();
    let (_, input, output) = TABLE;
    let output = table(reflection, output).ok_or_else(|| GpuError::Unsupported {
        what: "probing".into(),
        needs: "a result that a buffer can hold".into(),
    })?;
    let arguments = table(reflection, input);
    let mut packed = Vec::with_capacity(inputs.len());
    let mut batches: IndexMap<String, Batch> = IndexMap::new();
    for (i, row) in inputs.iter().enumerate() {
        let path = format!("[{i}]");
        let (bytes, params, instances) = read_row(row, arguments, &names.defaults, &path)?;
        packed.push(bytes);
        let batch = batches.entry(format!("{params}{instances}")).or_default();
        if batch.rows.is_empty() {
            batch.params = resolve_params(&params, reflection, names, &path)?;
            batch.instances = instances;
        }
        batch.rows.push(i);
    }
    let mut results = vec![Json::Null; inputs.len()];
    for batch in batches.values() {
        let tables = Tables {
            arguments,
            output,
            packed: &packed,
        };
        run_batch(pipelines, gpu, program, batch, &tables, &mut results)?;
    }
    Ok(results)
}

/// Layout of the elements of a table.
fn table<'a>(reflection: &'a Reflection, name: &str) -> Option<&'a Layout> {
    let found = reflection.bindings.iter().find(|b| is_host(b, name))?;
    match &found.ty {
        BindingType::Storage { layout, .. } => Some(layout),
        _ => None,
    }
}

/// Whether the host fills the binding under this name.
fn is_host(binding: &Binding, name: &str) -> bool {
    matches!(&binding.fill, Fill::Resource { declared: ResourceKind::Host(host), .. } if host == name)
}

/// A row's bytes, parameters and instances.
fn read_row(row: &Json, arguments: Option<&Layout>, defaults: &Defaults, path: &str) -> Result<(Vec<u8>, Json, Json), DataError> {
    let Json::Object(row) = row else {
        return Err(DataError::new(path, "expected an object keyed by argument name"));
    };
    let element = arguments.and_then(|a| a.element.as_deref());
    let members = element.map_or(&[][..], |e| &e.members);
    let mut given = row.clone();
    let params = given.shift_remove("params").unwrap_or(Json::Null);
    let instances = given.shift_remove("instances").unwrap_or(Json::Null);
    if let Some(name) = given.keys().find(|name| !members.iter().any(|m| m.name == **name)) {
        return Err(unknown(
            name,
            "argument",
            "the function",
            members.iter().map(|m| m.name.as_str()),
            path,
        ));
    }
    for member in members.iter().filter(|m| !given.contains_key(&m.name)).collect::<Vec<_>>() {
        if member.layout.members.is_empty() {
            let message = format!("argument `{}` of type {} is missing", member.name, member.layout.ty);
            return Err(DataError::new(path, message));
        }
        given.insert(member.name.clone(), Json::Object(Map::new()));
    }
    let mut bytes = vec![0; arguments.map_or(0, |a| a.stride.unwrap_or(0) as usize)];
    if let Some(element) = element {
        pack(element, &Json::Object(given), path, defaults, &mut bytes)?;
    }
    Ok((bytes, params, instances))
}

/// Parameters of a row by `instance.name`. A bare name means the root's parameter, or the only one of that name.
fn resolve_params(given: &Json, reflection: &Reflection, names: &Names, path: &str) -> Result<IndexMap<String, Value>, DataError> {
    let path = format!("{path}.params");
    let given = match given {
        Json::Null => return Ok(IndexMap::new()),
        Json::Object(given) => given,
        _ => return Err(DataError::new(path, "expected an object keyed by parameter name")),
    };
    let root = reflection.instances.first().map_or("", |i| i.name.as_str());
    let mut params = IndexMap::new();
    for (name, value) in given {
        let path = format!("{path}.{name}");
        let is_named = |instance: &str, param: &str| *name == param || *name == format!("{instance}.{param}");
        let mut found: Vec<&ParamUse> = reflection.params.iter().filter(|p| is_named(&p.instance, &p.name)).collect();
        if found.len() > 1 && found.iter().any(|p| p.instance == root) {
            found.retain(|p| p.instance == root);
        }
        match found[..] {
            [] if names.unread.iter().any(|(instance, param)| is_named(instance, param)) => {}
            [] => {
                return Err(unknown(
                    name,
                    "parameter",
                    "the recipe",
                    reflection.params.iter().map(|p| p.name.as_str()),
                    &path,
                ));
            }
            [param] => {
                if matches!(param.place, ParamPlace::Constant { .. }) {
                    return Err(DataError::new(
                        path,
                        "is a constant of this recipe; freeze it to another value there",
                    ));
                }
                params.insert(format!("{}.{}", param.instance, param.name), manifest_value(value, &path)?);
            }
            _ => {
                let all: Vec<_> = found.iter().map(|p| format!("`{}.{}`", p.instance, p.name)).collect();
                return Err(DataError::new(path, format!("is one of {}; say which", all.join(", "))));
            }
        }
    }
    Ok(params)
}

fn manifest_value(value: &Json, path: &str) -> Result<Value, DataError> {
    serde_json::from_value(value.clone()).map_err(|error| DataError::new(path, error.to_string()))
}

/// Rows of one instance buffer, from a list, or from an object with a list for each instance of a module.
fn rows_of(given: &Json, instance: &str, only: bool, path: &str) -> Result<Vec<IndexMap<String, Value>>, DataError> {
    let list = match given {
        Json::Null => None,
        Json::Array(list) if only => Some(list),
        Json::Object(by_name) => match by_name.get(instance) {
            None => None,
            Some(Json::Array(list)) => Some(list),
            Some(_) => return Err(DataError::new(format!("{path}.{instance}"), "expected a list of objects")),
        },
        _ if only => return Err(DataError::new(path, "expected a list of objects")),
        _ => {
            return Err(DataError::new(
                path,
                "several modules have instances: expected an object with a list for each",
            ));
        }
    };
    let Some(list) = list else { return Ok(vec![IndexMap::new()]) };
    if list.is_empty() {
        return Err(DataError::new(path, "expected at least one instance"));
    }
    let row = |(i, fields): (usize, &Json)| {
        let path = format!("{path}[{i}]");
        let Json::Object(fields) = fields else {
            return Err(DataError::new(path, "expected an object"));
        };
        let value = |(name, value): (&String, &Json)| Ok((name.clone(), manifest_value(value, &format!("{path}.{name}"))?));
        fields.iter().map(value).collect()
    };
    list.iter().enumerate().map(row).collect()
}

/// The table's layouts and its packed rows.
struct Tables<'a> {
    arguments: Option<&'a Layout>,
    output: &'a Layout,
    packed: &'a [Vec<u8>],
}

fn run_batch(
    pipelines: &Pipelines,
    gpu: &Gpu,
    program: &Program,
    batch: &Batch,
    tables: &Tables,
    results: &mut [Json],
) -> Result<(), RuntimeError> {
    use wgpu::BufferUsages as U;
    let reflection = program.reflection();
    let value = |param: &ParamUse| batch.params.get(&format!("{}.{}", param.instance, param.name)).cloned();
    let Some(entry) = reflection.entry_points.first() else {
        return Ok(());
    };
    let pipeline = pipelines.compute(program, &entry.name, &constants(reflection, value)?)?;
    let blocks = param_blocks(reflection, value)?;
    let buffers = reflection
        .bindings
        .iter()
        .filter(|b| matches!(b.fill, Fill::Instances { .. }))
        .count();
    let path = format!("[{}].instances", batch.rows[0]);
    let resource = |binding: &Binding| -> Result<Bound, RuntimeError> {
        Ok(match (&binding.fill, &binding.ty) {
            (Fill::Params, _) => {
                let bytes = blocks.get(&(binding.group, binding.binding)).map_or(&[][..], |b| b);
                Bound::Buffer(gpu.buffer(&binding.name, U::UNIFORM, bytes, 0)?)
            }
            (Fill::Instances { instance }, BindingType::Storage { layout, .. }) => {
                let rows = rows_of(&batch.instances, instance, buffers == 1, &path)?;
                let bytes = instance_rows(layout, fields_of(reflection, instance), &rows, &path)?;
                Bound::Buffer(gpu.buffer(&binding.name, U::STORAGE, &bytes, 0)?)
            }
            (
                Fill::Resource {
                    declared: ResourceKind::Sampler { linear, repeat, compare },
                    ..
                },
                _,
            ) => sampler(gpu, *linear, *repeat, *compare)?,
            _ => stand_in(gpu, binding)?,
        })
    };
    let mut groups: Vec<Option<wgpu::BindGroup>> = Vec::new();
    for group in 0..TABLE.0 {
        groups.push(Some(bind_group(gpu, &pipeline, reflection, group, &resource)?));
    }
    let workgroup = u64::from(entry.workgroup_size.map_or(1, |size| size[0]).max(1));
    let out_stride = u64::from(tables.output.stride.unwrap_or(4).max(1));
    let in_stride = u64::from(tables.arguments.and_then(|a| a.stride).unwrap_or(1).max(1));
    let limits = gpu.device().limits();
    let largest = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let rows_at_once = MOST_ROWS
        .min(largest / out_stride.max(in_stride))
        .min(u64::from(limits.max_compute_workgroups_per_dimension) * workgroup)
        .max(1);
    for rows in batch.rows.chunks(usize::try_from(rows_at_once).unwrap_or(1)) {
        let bytes: Vec<u8> = rows.iter().flat_map(|row| &tables.packed[*row]).copied().collect();
        let size = size_with(tables.output, rows.len());
        let results_buffer = gpu.buffer("probe results", U::STORAGE | U::COPY_SRC, &[], size)?;
        let table = bind_group(gpu, &pipeline, reflection, TABLE.0, |binding| match binding {
            b if is_host(b, TABLE.1) => Ok(Bound::Buffer(gpu.buffer("probe inputs", U::STORAGE, &bytes, 0)?)),
            b if is_host(b, TABLE.2) => Ok(Bound::Buffer(results_buffer.clone())),
            _ => resource(binding),
        })?;
        groups.truncate(TABLE.0 as usize);
        groups.push(Some(table));
        let commands = gpu.scoped("probe", |device| {
            let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = commands.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline.pipeline);
            for (index, group) in (0..).zip(&groups).take(GROUPS) {
                pass.set_bind_group(index, group, &[]);
            }
            let workgroups = (rows.len() as u64).div_ceil(workgroup);
            pass.dispatch_workgroups(u32::try_from(workgroups).unwrap_or(u32::MAX), 1, 1);
            drop(pass);
            commands
        })?;
        let bytes = gpu.read("probe", commands, &results_buffer, size)?;
        for (row, bytes) in rows.iter().zip(bytes.chunks(usize::try_from(out_stride).unwrap_or(1))) {
            let result = tables.output.element.as_ref().map_or(Json::Null, |element| unpack(element, bytes));
            results[*row] = match result {
                Json::Object(mut object) if object.contains_key("value") => object["value"].take(),
                other => other,
            };
        }
    }
    Ok(())
}

/// Declared fields of an instance's buffer.
pub(crate) fn fields_of<'a>(reflection: &'a Reflection, instance: &str) -> &'a IndexMap<String, Param> {
    static NONE: std::sync::LazyLock<IndexMap<String, Param>> = std::sync::LazyLock::new(IndexMap::new);
    reflection
        .instances
        .iter()
        .find(|i| i.name == instance)
        .map_or(&NONE, |i| &i.fields)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::testing::{catalog, gpu};

    const CATEGORY: &str = "(summary: \"tested\", order: 1, group: 2, defaults: {\"S\": {\"alpha\": 0.5}})";
    const INTERFACE: &str = "
        struct S { n: vec3f, alpha: f32, unread: vec2f }
        fn eval(s: S, v: vec3f, k: u32) -> vec3f { return vec3f(0.0); }";
    const MANIFEST: &str = "(
        summary: \"tested\",
        params: {
            \"scale\": (type: F32, default: 1.0, range: Some((0.0, 10.0))),
            \"other\": (type: F32, default: 1.0),
            \"gain\": (type: F32, default: 1.0, mode: Override),
            \"fixed\": (type: U32, default: 1, mode: Constant),
        },
        instances: {\"power\": (type: F32, default: 0.25), \"gone\": (type: F32, default: 0.0)},
        resources: {\"tint\": (kind: Texture())},
    )";
    const SOURCE: &str = "
        var tint: texture_2d<f32>;
        fn eval(s: S, v: vec3f, k: u32) -> vec3f {
            var sum = 0.0;
            for (var l = 0u; l < arrayLength(&instances); l++) { sum += instances[l].power; }
            let white = textureLoad(tint, vec2u(0u), 0).x;
            return s.n * s.alpha * params.scale + v * f32(k * params.fixed) + vec3f(sum * white, params.gain * f32(arrayLength(&instances)), 1.0 / v.z);
        }";

    fn run(inputs: &[Json]) -> Result<Vec<Json>, RuntimeError> {
        let catalog = catalog(&[
            ("tested/category.ron", CATEGORY),
            ("tested/interface.wgsl", INTERFACE),
            ("tested/lamp/module.ron", MANIFEST),
            ("tested/lamp/lamp.wgsl", SOURCE),
        ]);
        let recipe = Recipe::parse("test", "\"lamp\"").unwrap();
        let answer = probe(&gpu(), &catalog, &recipe, "eval", inputs)?;
        assert_eq!((&answer["function"], &answer["device"]), (&json!("eval"), &json!(gpu().name())));
        Ok(answer["results"].as_array().unwrap().clone())
    }

    /// Catches lost order between batches, defaults and parameters that do not arrive, a padded instance buffer
    /// (its length would add lamps) and textures that are not white.
    #[test]
    fn rows_come_back_in_order() {
        let rows = [
            json!({"s": {"n": [2, 4, 8], "unread": [1, 2]}, "v": [0, 0, 1], "k": 0}),
            json!({"s": {"n": [2, 4, 8], "alpha": 1}, "v": [1, 2, 4], "k": 3, "params": {"scale": 2}}),
            json!({"v": [1, 2, 0], "k": 1, "instances": [{"power": 1}, {"power": 2}, {"gone": 7}], "params": {"other": 1, "gain": -2}}),
            json!({"s": {"n": [0, 0, 2]}, "v": [0, 0, -1], "k": 0, "params": {"lamp.scale": 4}}),
        ];
        let expected = json!([[1.25, 3.0, 5.0], [7.25, 15.0, 28.25], [4.25, -4.0, "Infinity"], [0.25, 1.0, 3.0]]);
        assert_eq!(Json::Array(run(&rows).unwrap()), expected);
    }

    /// Catches the table being looked for at fixed bindings: parameters of a category of group 3 come before it.
    #[test]
    fn the_table_shares_its_group() {
        let catalog = catalog(&[
            ("tested/category.ron", "(summary: \"tested\", order: 1, group: 3)"),
            ("tested/interface.wgsl", "fn eval(x: f32) -> f32 { return x; }"),
            (
                "tested/scale/module.ron",
                "(summary: \"tested\", params: {\"by\": (type: F32, default: 3.0)})",
            ),
            ("tested/scale/scale.wgsl", "fn eval(x: f32) -> f32 { return params.by * x; }"),
        ]);
        let recipe = Recipe::parse("test", "\"scale\"").unwrap();
        let answer = probe(
            &gpu(),
            &catalog,
            &recipe,
            "eval",
            &[json!({"x": 2}), json!({"x": 2, "params": {"by": 5}})],
        )
        .unwrap();
        assert_eq!(answer["results"], json!([6.0, 10.0]));
    }

    /// Catches a table that is cut at a dispatch's or a chunk's limit.
    #[test]
    fn large_tables_come_back_whole() {
        let count = usize::try_from(MOST_ROWS).unwrap() + 3;
        let rows: Vec<_> = (0..count).map(|i| json!({"v": [i % 1000, 0, 1], "k": 1})).collect();
        let results = run(&rows).unwrap();
        assert_eq!(results.len(), count);
        for (i, result) in results.iter().enumerate() {
            assert_eq!(result[0], json!((i % 1000) as f64 + 0.25), "row {i}");
        }
    }

    /// Catches bad rows that are taken, and errors that do not say where.
    #[test]
    fn bad_rows_are_located() {
        let fail = |row: Json| run(&[json!({"v": [0, 0, 1], "k": 0}), row]).unwrap_err().to_string();
        assert_eq!(fail(json!([])), "[1]: expected an object keyed by argument name");
        assert_eq!(fail(json!({"v": [0, 0, 1]})), "[1]: argument `k` of type u32 is missing");
        assert_eq!(
            fail(json!({"v": [0, 0, 1], "kk": 0})),
            "[1]: the function has no argument `kk`; did you mean `k`?"
        );
        assert_eq!(fail(json!({"v": [0, 0], "k": 0})), "[1].v: vec3<f32> has 3 components, found 2");
        assert_eq!(
            fail(json!({"v": [0, 0, 1], "k": 0, "params": {"scal": 1}})),
            "[1].params.scal: the recipe has no parameter `scal`; did you mean `scale`?"
        );
        assert_eq!(
            fail(json!({"v": [0, 0, 1], "k": 0, "params": {"scale": [1, 2]}})),
            "lamp.scale: expected a number, found 2 numbers"
        );
        assert_eq!(
            fail(json!({"v": [0, 0, 1], "k": 0, "params": {"scale": 11}})),
            "lamp.scale: 11 is outside 0 to 10"
        );
        assert_eq!(
            fail(json!({"v": [0, 0, 1], "k": 0, "params": {"fixed": 2}})),
            "[1].params.fixed: is a constant of this recipe; freeze it to another value there"
        );
        assert_eq!(
            fail(json!({"v": [0, 0, 1], "k": 0, "instances": [{"powr": 1}]})),
            "[1].instances[0]: the instance has no field `powr`; did you mean `power`?"
        );
        assert_eq!(
            fail(json!({"v": [0, 0, 1], "k": 0, "instances": []})),
            "[1].instances: expected at least one instance"
        );
    }
}

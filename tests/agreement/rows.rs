//! Seeded inputs for any function: usual ones and hard ones, by the names and types of its arguments.

use serde_json::{Map, Value as Json, json};
use shadewright::compiler::manifest::{Param, ParamType};
use shadewright::compiler::reflect::{Layout, ParamPlace, Reflection};

/// SplitMix64 (Steele, Lea and Flood 2014).
pub struct Random(pub u64);

impl Random {
    pub fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.word() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Over orders of magnitude.
    fn log(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[(self.word() % list.len() as u64) as usize]
    }

    /// A unit vector; a hard one at the normal, the horizon, or an axis.
    fn direction(&mut self, hard: bool) -> [f64; 3] {
        let axes = [
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, -1.0],
            [-1.0, 0.0, 0.0],
            [0.6, 0.0, 0.8],
        ];
        let phi = self.between(0.0, std::f64::consts::TAU);
        let z = match (hard, self.word() % 4) {
            (true, 0) => return self.of(&axes),
            (true, 1) => self.log(1e-7, 1e-2),
            (true, 2) => 1.0 - self.log(1e-7, 1e-3),
            (true, _) => -self.unit(),
            (false, _) => self.unit(),
        };
        let r = (1.0 - z * z).max(0.0).sqrt();
        [r * phi.cos(), r * phi.sin(), z]
    }
}

/// What numbers an argument of a name takes.
fn number(name: &str, random: &mut Random, hard: bool) -> f64 {
    match name {
        "alpha" | "roughness" => match hard {
            true => random.of(&[1e-4, 1e-3, 0.002_025, 1.0, 0.5]),
            false => random.log(1e-3, 1.0),
        },
        // A uniform number.
        "u" => match hard {
            true => random.of(&[0.0, 0.5, 0.25, 0.999_999_94, 1e-7]),
            false => random.unit(),
        },
        "opacity" => random.unit(),
        "cosine" => match hard {
            true => random.of(&[0.0, 1.0, -1.0, 1.0 + 1e-7, 1e-20, 0.999_999_9]),
            false => random.unit(),
        },
        "distance" => random.log(1e-3, 1e3),
        "depth" => random.unit(),
        _ => match hard {
            true => random.of(&[0.0, 1.0, -1.0, 0.5, 1e-4, 1e-10, 65504.0, 1e10]),
            false => random.between(-2.0, 2.0),
        },
    }
}

/// A value of a layout, by the name of the member or argument that it is for.
fn value(layout: &Layout, name: &str, random: &mut Random, hard: bool) -> Json {
    if !layout.members.is_empty() {
        let mut object = Map::new();
        for member in &layout.members {
            object.insert(member.name.clone(), value(&member.layout, &member.name, random, hard));
        }
        return Json::Object(object);
    }
    // One thing at a time is hard.
    let hard = hard && random.word().is_multiple_of(3);
    match layout.ty.as_str() {
        "u32" if name == "layer" || name == "light" => json!(0),
        "u32" | "i32" => json!(random.word() % 3),
        "vec2<u32>" => json!([random.word() % 3, random.word() % 3]),
        "f32" => json!(number(name, random, hard)),
        "vec3<f32>" => match name {
            "v" | "l" | "h" | "direction" | "normal" | "geometric_normal" => json!(random.direction(hard)),
            "diffuse" | "f0" => json!([random.unit(), random.unit(), random.unit()]),
            "emission" | "c" | "color" => json!([0; 3].map(|_| if hard {
                random.of(&[0.0, 65504.0, 1e-6, 1e4])
            } else {
                random.log(1e-3, 1e4)
            })),
            _ => json!([0; 3].map(|_| number(name, random, hard))),
        },
        "vec4<f32>" if name == "tangent" => {
            let [x, y, z] = random.direction(hard);
            json!([x, y, z, random.of(&[-1.0, 1.0])])
        }
        "vec4<f32>" => json!([0; 4].map(|_| number(name, random, hard))),
        "vec2<f32>" => json!([0; 2].map(|_| number(name, random, hard))),
        other => panic!("no inputs for {name}: {other}"),
    }
}

/// A value of a parameter within its range; ends of the range are the hard ones.
fn parameter(param: &Param, random: &mut Random, hard: bool) -> Json {
    let (low, high) = param.range.unwrap_or((-1.0, 1.0));
    let mut one = || match hard && random.word().is_multiple_of(2) {
        true => random.of(&[low, high]),
        false if low > 0.0 && high / low > 100.0 => random.log(low, high),
        false if low == 0.0 && high > 100.0 => random.log(1e-3, high),
        false => random.between(low, high),
    };
    match param.ty {
        ParamType::F32 => json!(one()),
        ParamType::U32 | ParamType::I32 => json!(one().round()),
        ParamType::Bool => json!(one() > 0.0),
        ParamType::Vec2 => json!([one(), one()]),
        ParamType::Vec3 => json!([one(), one(), one()]),
        ParamType::Vec4 => json!([one(), one(), one(), one()]),
        _ => json!([one(), one(), one()]),
    }
}

/// Parameters and instances that many rows share: the defaults for seed 0.
fn shared(reflection: &Reflection, seed: u64, random: &mut Random) -> Map<String, Json> {
    let mut row = Map::new();
    if seed == 0 {
        return row;
    }
    let hard = seed.is_multiple_of(2);
    let mut params = Map::new();
    for param in &reflection.params {
        if !matches!(param.place, ParamPlace::Constant { .. }) {
            params.insert(
                format!("{}.{}", param.instance, param.name),
                parameter(&param.declared, random, hard),
            );
        }
    }
    if !params.is_empty() {
        row.insert("params".to_owned(), Json::Object(params));
    }
    let mut instances = Map::new();
    for instance in reflection.instances.iter().filter(|i| !i.fields.is_empty()) {
        let mut fields = |hard| {
            instance
                .fields
                .iter()
                .map(|(name, field)| (name.clone(), parameter(field, random, hard)))
                .collect::<Map<_, _>>()
        };
        let list = [fields(false), fields(hard)];
        instances.insert(instance.name.clone(), json!(list));
    }
    if instances.len() == 1 {
        row.insert(
            "instances".to_owned(),
            instances.into_iter().next().map_or(Json::Null, |(_, list)| list),
        );
    } else if !instances.is_empty() {
        row.insert("instances".to_owned(), Json::Object(instances));
    }
    row
}

/// So many rows for a function: every other one hard, in five sets of parameters.
pub fn rows(reflection: &Reflection, arguments: Option<&Layout>, count: usize) -> Vec<Json> {
    let mut random = Random(0x005e_ed0f_0a61);
    let sets: Vec<Map<String, Json>> = (0..5).map(|seed| shared(reflection, seed, &mut random)).collect();
    let element = arguments.and_then(|layout| layout.element.as_deref());
    (0..count)
        .map(|i| {
            let mut row = sets[i % sets.len()].clone();
            for member in element.iter().flat_map(|e| &e.members) {
                row.insert(member.name.clone(), value(&member.layout, &member.name, &mut random, i % 2 == 1));
            }
            Json::Object(row)
        })
        .collect()
}

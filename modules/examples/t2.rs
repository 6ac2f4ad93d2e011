use shadewright_compiler::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let c = Catalog::load(shadewright_modules::library()).unwrap();
    let r = Recipe::parse("r", &a[1]).unwrap_or_else(|e| {
        eprintln!("{e}");
        std::process::exit(1)
    });
    let p = c.compile(&r, a.get(2).map_or("main", |s| s)).unwrap_or_else(|e| {
        eprintln!("{e}");
        std::process::exit(1)
    });
    let m = canonical::canonical_module("x", p.wgsl()).unwrap_or_else(|e| {
        eprintln!("{e}");
        std::process::exit(1)
    });
    let strip = |m: &naga::Module| {
        let mut s = String::new();
        for (h, t) in m.types.iter() {
            s += &format!("{h:?} {:?}\n", t);
        }
        for (h, t) in m.constants.iter() {
            s += &format!("{h:?} {:?}\n", t);
        }
        for (h, t) in m.global_expressions.iter() {
            s += &format!("{h:?} {:?}\n", t);
        }
        for (h, t) in m.global_variables.iter() {
            s += &format!("{h:?} {:?}\n", t);
        }
        for (_, f) in m.functions.iter() {
            s += &format!("{:#?}\n", f);
        }
        for e in &m.entry_points {
            s += &format!("{:#?}\n", e);
        }
        s
    };
    std::fs::write("/tmp/a.txt", strip(p.validated().module())).unwrap();
    std::fs::write("/tmp/b.txt", strip(&m)).unwrap();
    println!("{} {}", p.reflection().hash, format!("{:032x}", hash::structural_hash(&m)));
}

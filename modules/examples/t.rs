use shadewright_compiler::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let c = match Catalog::load(shadewright_modules::library()) {
        Ok(c) => c,
        Err(e) => {
            eprintln!("{e}");
            std::process::exit(1)
        }
    };
    let r = Recipe::parse("r", &a[1]).unwrap_or_else(|e| {
        eprintln!("{e}");
        std::process::exit(1)
    });
    let pass = a.get(2).map_or("main", |s| s);
    let p = match pass.strip_prefix("probe:") {
        Some(f) => c.compile_probe(&r, f),
        None => c.compile(&r, pass),
    };
    match p {
        Ok(p) => {
            println!("{}", p.wgsl());
            eprintln!("{}", p.reflection().hash);
            for b in &p.reflection().bindings {
                eprintln!("{} {} {} {:?}", b.group, b.binding, b.name, b.stages);
            }
            for f in &p.reflection().functions {
                eprintln!("{} {}:{} {:?}", f.name, f.file, f.line, p.why(&f.name));
            }
        }
        Err(e) => {
            eprintln!("{e}");
            std::process::exit(1)
        }
    }
}

use shadewright_compiler::*;
fn main(){ let a: Vec<String>=std::env::args().collect(); let c=match Catalog::load(shadewright_modules::library()){Ok(c)=>c,Err(e)=>{eprintln!("{e}");std::process::exit(1)}};
 let r=Recipe::parse("r",&a[1]).unwrap_or_else(|e|{eprintln!("{e}");std::process::exit(1)});
 match c.compile(&r,a.get(2).map_or("main",|s|s)){Ok(p)=>{println!("{}",p.wgsl()); eprintln!("{}",serde_json::to_string(p.reflection()).unwrap().len()); eprintln!("{}",p.reflection().hash); for b in &p.reflection().bindings {eprintln!("{} {} {} {:?}",b.group,b.binding,b.name,b.stages);} },Err(e)=>{eprintln!("{e}");std::process::exit(1)}} }

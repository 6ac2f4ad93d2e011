//! Instructions of a SPIR-V module by kind.
#![allow(dead_code, clippy::unwrap_used)]

use std::io::Write as _;
use std::process::Command;

use shadewright::compiler::validate::Validated;
use shadewright::compiler::{Target, emit};

/// Instructions inside functions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Functions.
    pub functions: usize,
    /// Everything from `OpFunction` to `OpFunctionEnd`, both counted.
    pub all: usize,
    /// Arithmetic, comparisons, conversions, library functions, taking apart and putting together.
    pub arithmetic: usize,
    /// Loads, stores and address computations.
    pub memory: usize,
    /// Texture instructions.
    pub texture: usize,
    /// Calls.
    pub calls: usize,
    /// What makes up functions and flow: labels, branches, merges, parameters, local variables, returns.
    pub structure: usize,
}

/// Counts a module.
pub fn count(spirv: &[u8]) -> Count {
    let words: Vec<u32> = spirv
        .chunks_exact(4)
        .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    assert_eq!(words[0], 0x0723_0203, "no SPIR-V of this machine's byte order");
    let mut count = Count::default();
    let mut inside = false;
    let mut at = 5;
    while at < words.len() {
        // The numbers are those of the SPIR-V specification, section 3.49.
        let opcode = words[at] & 0xffff;
        inside |= opcode == 54;
        if inside {
            count.all += 1;
            match opcode {
                54 => {
                    count.functions += 1;
                    count.structure += 1;
                }
                57 => count.calls += 1,
                61..=68 => count.memory += 1,
                86..=107 => count.texture += 1,
                12 | 77..=84 | 109..=205 | 207..=215 => count.arithmetic += 1,
                55 | 56 | 59 | 245..=255 => count.structure += 1,
                other => panic!("an instruction of no known kind: {other}"),
            }
        }
        inside &= opcode != 56;
        at += (words[at] >> 16).max(1) as usize;
    }
    count
}

/// A shader as naga writes it.
pub fn spirv(shader: &Validated) -> Vec<u8> {
    emit(shader, Target::SpirV, None).unwrap_or_else(|report| panic!("{report}"))
}

/// The module as an optimiser leaves it, which inlines all; `None` where none is installed, which is said.
pub fn optimised(spirv: &[u8]) -> Option<Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("in.spv"), folder.path().join("out.spv"));
    std::fs::write(&from, spirv).unwrap();
    match Command::new("spirv-opt").arg("-O").arg(&from).arg("-o").arg(&to).status() {
        Ok(status) => {
            assert!(status.success(), "spirv-opt refuses it");
            Some(std::fs::read(to).unwrap())
        }
        Err(_) => {
            let _ = writeln!(std::io::stdout(), "spirv-opt is not installed: its counts are missing");
            None
        }
    }
}

//! What modules claim and how far it holds, as Markdown.

use std::collections::BTreeMap;

use super::markdown::cell;
use super::number::number;
use crate::proofs::{Combinations, Proof, Property, SIGNIFICANCE};

/// What stands above the tables.
const HEAD: &str = "# What reflectance models claim, and how far it holds

Made by `shadewright report --properties spec/brdf.md`, which ends with an error where something that is claimed does not hold. What a property
is and how it is measured stands in [report.md](report.md#properties).

";

/// The page: an overview, for each property a table of all modules that can have it, and what came of all combinations.
pub fn proofs(device: &str, samples: usize, proofs: &[Proof], combinations: &[Combinations]) -> String {
    let claims = proofs.iter().filter(|p| p.claimed).count();
    let broken = proofs.iter().filter(|p| p.is_broken()).count();
    let mut text = format!(
        "{HEAD}Measured on {}, {samples} samples for a chi-square test. {claims} claims, {broken} of them broken.\n",
        cell(device)
    );
    text += &overview(proofs);
    for property in Property::ALL {
        let of: Vec<&Proof> = proofs.iter().filter(|p| p.property == property).collect();
        if !of.is_empty() {
            text += &section(property, &of);
        }
    }
    text + &combinations.iter().map(combined).collect::<String>()
}

/// Title, what the number is, and whether it must be claimed.
fn words(property: Property) -> (&'static str, &'static str) {
    match property {
        Property::Reciprocal => ("reciprocal", "Largest relative difference when v and l are exchanged."),
        Property::Isotropic => (
            "isotropic",
            "Largest relative difference when v and l are turned about the normal by a quarter, half of the surfaces having another width across the tangent.",
        ),
        Property::NotNegative => ("not negative", "Least value."),
        Property::Finite => (
            "finite",
            "Values that are not finite, alpha from 1e-4, angles to 89.99 degrees, on and below the horizon.",
        ),
        Property::Share => ("share", "Largest value; no more than 1 is reflected."),
        Property::Energy => (
            "albedo",
            "Largest albedo of white surfaces (f0 and 1 - f0 of the diffuse part) by quadrature; ± is what twice as many nodes in each direction change.",
        ),
        Property::Normalised => (
            "normalised",
            "Largest distance from 1 of the integral of D n.h over the hemisphere.",
        ),
        Property::ProjectedArea => (
            "projected area",
            "Largest relative distance of the area of the facets that v sees from that of the surface, with Smith's masking 4 n.v V(v, n).",
        ),
        Property::Drawn => (
            "drawn as said",
            "Smallest probability among the chi-square tests of what is drawn against its density.",
        ),
        Property::Weight => (
            "weight",
            "Largest weight f n.l / p of a sample; of pairs that of white facets, which is at most 1.",
        ),
    }
}

/// A row for each module, a column for each property; in brackets what is not claimed.
fn overview(proofs: &[Proof]) -> String {
    let used: Vec<Property> = Property::ALL
        .into_iter()
        .filter(|p| proofs.iter().any(|proof| proof.property == *p))
        .collect();
    let mut modules: Vec<&str> = Vec::new();
    let mut cells: BTreeMap<(&str, Property), String> = BTreeMap::new();
    for proof in proofs {
        if !modules.contains(&proof.module.as_str()) {
            modules.push(&proof.module);
        }
        let value = number(proof.worst);
        let value = match (proof.claimed, proof.holds()) {
            (true, true) => value,
            (true, false) => format!("**{value}**"),
            (false, _) => format!("({value})"),
        };
        cells.insert((&proof.module, proof.property), value);
    }
    let names: Vec<&str> = used.iter().map(|p| words(*p).0).collect();
    let mut text = format!(
        "\n## Overview\n\nThe worst value of each; in brackets what is not claimed, bold what is claimed and does not hold.\n\n| module | {} |\n|{}\n",
        names.join(" | "),
        "---|".repeat(used.len() + 1)
    );
    for module in modules {
        let row: Vec<String> = used.iter().map(|p| cells.get(&(module, *p)).cloned().unwrap_or_default()).collect();
        text += &format!("| {} | {} |\n", cell(module), row.join(" | "));
    }
    text
}

fn section(property: Property, proofs: &[&Proof]) -> String {
    let (title, what) = words(property);
    let bound = match property {
        Property::Drawn => format!(" The tests together fail a correct library with the probability {SIGNIFICANCE}."),
        _ => String::new(),
    };
    let mut text =
        format!("\n## {title}\n\n{what}{bound}\n\n| module | claimed | worst | bound | holds | where |\n|---|---|---|---|---|---|\n");
    for proof in proofs {
        let bound = if proof.bound == f64::MAX {
            "finite".to_owned()
        } else {
            number(proof.bound)
        };
        let word = |is: bool| if is { "yes" } else { "no" };
        let cells = [
            cell(&proof.module),
            word(proof.claimed).to_owned(),
            if property == Property::Energy {
                format!("{:.5}", proof.worst)
            } else {
                number(proof.worst)
            },
            bound,
            if proof.is_broken() {
                "**no**".to_owned()
            } else {
                word(proof.holds()).to_owned()
            },
            cell(&proof.at),
        ];
        text += &format!("| {} |\n", cells.join(" | "));
    }
    text
}

fn combined(found: &Combinations) -> String {
    let slots: Vec<String> = found.slots.iter().map(|(slot, count)| format!("{count} {slot}")).collect();
    format!(
        "\n## Combinations of {}\n\n{}: {} combinations, all of them linked, validated and evaluated in f32; {} programs differ. {} samplers differ, \
        each held against its density. {} of the combinations hold every pair of alternatives and were evaluated on the device too.\n\n\
        | | |\n|---|---|\n| faults | {} |\n| must be reciprocal by their parts' claims | {} |\n| largest relative difference of these | {}, {} |\n\
        | smallest probability of a sampler | {}, {} |\n",
        cell(&found.module),
        slots.join(", "),
        found.count,
        found.programs,
        found.samplers,
        found.on_device,
        found.faults.len(),
        found.reciprocal,
        number(found.worst.0),
        cell(&found.worst.1),
        number(found.least.0),
        cell(&found.least.1),
    )
}

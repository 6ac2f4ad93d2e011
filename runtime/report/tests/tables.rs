//! JSON, CSV and Markdown.

#![allow(clippy::expect_used)]

mod sample;

use shadewright_report::data::{Errors, Report};
use shadewright_report::write::{files, markdown};

fn file(report: &Report, name: &str) -> String {
    let files = files(report).expect("files");
    let (_, bytes) = files.into_iter().find(|(found, _)| found == name).expect("the file");
    String::from_utf8(bytes).expect("UTF-8")
}

/// Catches digits that are lost on the way.
#[test]
fn finite_reports_come_back_equal() {
    let report = Report {
        experiments: vec![sample::masking(), sample::lonely()],
        ..sample::report()
    };
    let read: Report = serde_json::from_str(&file(&report, "report.json")).expect("a report");
    assert!(read == report);
}

/// Catches a NaN or an infinity that makes the file no JSON, or JSON that cannot be read as a report.
#[test]
fn what_is_not_finite_is_null_and_can_be_read() {
    let report = sample::report();
    let text = file(&report, "report.json");
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let row = &value["experiments"][2]["rows"][1];
    assert_eq!(row["label"], "nan");
    assert!(row["model"]["rms"].is_null() && row["executed"]["max"].is_null() && row["picture"]["worst"][0].is_null());
    let read: Report = serde_json::from_str(&text).expect("a report");
    let model = |report: &Report, row: usize| -> Errors { report.experiments[2].rows[row].model.clone().expect("errors") };
    assert!(model(&read, 1).rms.is_nan());
    assert!(model(&read, 0).rms.is_nan(), "infinity is no longer told from NaN");
    assert_eq!(model(&read, 2).rms, 5e-324);
    assert_eq!(file(&read, "report.json"), text);
}

/// Catches a missing, moved or renamed column, and cells that break the table.
#[test]
fn rows_are_a_table() {
    let report = sample::report();
    let text = file(&report, "rows.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> = reader.headers().expect("a header").iter().map(str::to_owned).collect();
    let expected = "experiment category function row recipe baseline dominated model_rms model_p95 model_max model_bias model_searched \
                    rounding_device_rms rounding_device_p95 rounding_device_max rounding_device_bias rounding_device_searched rounding_cpu_rms \
                    rounding_cpu_p95 rounding_cpu_max rounding_cpu_bias rounding_cpu_searched rounding_allowed nan infinite negative discontinuous \
                    executed_mean executed_max loop_trips texture_reads time_median time_p10 time_p90 nanoseconds cost_add cost_multiply cost_divide \
                    cost_root cost_transcendental cost_select cost_integer cost_texture cost_loops cost_branches cost_uniform_bytes cost_bindings";
    assert_eq!(header, expected.split_whitespace().collect::<Vec<_>>());
    let rows: Vec<csv::StringRecord> = reader.records().map(|record| record.expect("a row")).collect();
    let of: Vec<_> = report
        .experiments
        .iter()
        .flat_map(|results| results.rows.iter().map(move |row| (results, row)))
        .collect();
    assert_eq!(rows.len(), of.len());
    let column = |name: &str| header.iter().position(|found| found == name).expect("a column");
    for (record, (results, row)) in rows.iter().zip(of) {
        assert_eq!((&record[0], &record[3]), (results.name.as_str(), row.label.as_str()));
        let number = |name: &str| record[column(name)].parse::<f64>().ok();
        // As text, in which every NaN is equal and no two other numbers are.
        let same = |found: Option<f64>, expected: Option<f64>| assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{record:?}");
        same(number("model_bias"), row.model.as_ref().map(|model| model.bias));
        same(
            number("rounding_device_searched"),
            row.rounding.as_ref().map(|rounding| rounding.searched),
        );
        same(number("rounding_allowed"), row.allowed);
        same(number("executed_max"), Some(row.executed.max));
        same(number("time_p90"), row.time.map(|time| time.p90));
        assert_eq!(record[column("nan")], row.verdict.nan.count.to_string());
        assert_eq!(record[column("discontinuous")], row.verdict.discontinuous.count.to_string());
        assert_eq!(record[column("cost_uniform_bytes")], row.cost.uniform_bytes.to_string());
        assert_eq!(record[column("dominated")], row.dominated.to_string());
    }
}

/// Catches columns that change with the machine, and any other change of the tables that are checked in.
#[test]
fn markdown_is_the_same_on_every_machine() {
    let mut report = Report {
        experiments: vec![sample::masking()],
        ..sample::report()
    };
    report.experiments[0].rows.truncate(1);
    report.experiments[0].rows.push(sample::masking().rows.swap_remove(8));
    let expected = "\
## brdf/masking

Masking and shadowing

`brdf` against Heitz 2014, eq. 99, in double precision; error relative, floor 1e-6; 4096 configurations (seed 7) and 32 hard.

| row | model RMS | p95 | max | bias | searched | rounding RMS | max | allowed | verdict | executed | at most |
|---|---|---|---|---|---|---|---|---|---|---|---|
| smith-correlated | 0 | 0 | 0 | 0 | 0 | 1.68e-7 | 8.40e-7 | 1.27e-5 | ok | 74.0 | 111 |
| cook-torrance | 0.190 | 0.380 | 0.950 | -0.0633 | 1.43 | 8.00e-7 | 4.00e-6 | 6.01e-5 | **3 NaN** | 19.0 | 28.5 |

| row | add | multiply | divide | root | uniform bytes | bindings |
|---|---|---|---|---|---|---|
| smith-correlated | 22 | 29 | 2 | 1 | 16 | 1 |
| cook-torrance | 5 | 7 | 2 | 1 | 16 | 1 |
";
    assert_eq!(markdown(&report), expected);
    report.provenance = Default::default();
    report.agreement.clear();
    for row in &mut report.experiments[0].rows {
        row.time = None;
        row.rounding = Some(sample::errors(f64::NAN));
    }
    assert_eq!(markdown(&report), expected);
}

/// Catches names that end their cell, or that Markdown takes for its own.
#[test]
fn markdown_holds_hostile_names() {
    let report = Report {
        experiments: vec![sample::hostile()],
        ..Report::default()
    };
    let text = markdown(&report);
    let tables = text.lines().filter(|line| line.starts_with('|'));
    let unescaped = |line: &str| line.replace("\\|", "").matches('|').count();
    let widths: Vec<usize> = tables.map(unescaped).collect();
    assert_eq!(widths.len(), 16);
    assert!(
        widths[..8].iter().all(|width| *width == 13) && widths[8..].iter().all(|width| *width == widths[8]),
        "{widths:?}\n{text}"
    );
    assert!(text.contains(r"| \<script\>alert(1)\</script\> "), "{text}");
    assert!(!text.contains(sample::HOSTILE) && !text.contains('\u{1b}'));
}

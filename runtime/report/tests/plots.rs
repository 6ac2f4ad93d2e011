//! Plots and pictures: what is drawn, and that SVG and PNG show the same.

#![allow(clippy::expect_used)]

mod sample;

use std::collections::BTreeMap;

use image::RgbImage;
use roxmltree::Document;
use shadewright_report::data::{Picture, Report, Results};
use shadewright_report::write::{WriteError, files};

const FRONTIER: &str = "#0B5FC1";
const DOMINATED: &str = "#939CA7";
const FAULT: &str = "#CF3A17";
const PAPER: &str = "#FFFFFF";

fn files_of(experiments: Vec<Results>) -> BTreeMap<String, Vec<u8>> {
    let report = Report {
        experiments,
        ..Report::default()
    };
    files(&report).expect("files").into_iter().collect()
}

fn text(files: &BTreeMap<String, Vec<u8>>, name: &str) -> String {
    String::from_utf8(
        files
            .get(name)
            .unwrap_or_else(|| panic!("{name} is not in {:?}", files.keys()))
            .clone(),
    )
    .expect("UTF-8")
}

fn picture(files: &BTreeMap<String, Vec<u8>>, name: &str) -> RgbImage {
    image::load_from_memory(&files[name]).expect("a PNG").to_rgb8()
}

/// A circle in an SVG, in its units of a quarter of a pixel.
#[derive(Clone, Debug, PartialEq)]
struct Circle {
    at: [f64; 2],
    radius: f64,
    fill: String,
    stroke: String,
    name: String,
}

fn circles(svg: &str) -> Vec<Circle> {
    let document = Document::parse(svg).unwrap_or_else(|error| panic!("no XML: {error}"));
    let circles = document.descendants().filter(|node| node.tag_name().name() == "circle");
    let number = |node: &roxmltree::Node<'_, '_>, name| node.attribute(name).and_then(|text| text.parse().ok()).expect("a number");
    circles
        .map(|node| Circle {
            at: [number(&node, "cx"), number(&node, "cy")],
            radius: number(&node, "r"),
            fill: node.attribute("fill").unwrap_or_default().to_owned(),
            stroke: node.attribute("stroke").unwrap_or_default().to_owned(),
            name: node.attribute("aria-label").unwrap_or_default().to_owned(),
        })
        .collect()
}

/// The point of a row: its colours, from the lowest mark to the highest.
fn colours_of(svg: &str, row: &str) -> Vec<String> {
    let circles = circles(svg);
    let target = circles.iter().find(|circle| circle.name.starts_with(&format!("{row};")));
    let at = target.unwrap_or_else(|| panic!("no point for {row}")).at;
    let here = circles.iter().filter(|circle| circle.at == at && circle.name.is_empty());
    here.map(|circle| {
        if circle.stroke == "none" {
            circle.fill.clone()
        } else {
            circle.stroke.clone()
        }
    })
    .collect()
}

/// Catches a dominated row that is not grey, one that is though nothing dominates it, and faults and truths without their marks.
#[test]
fn points_look_like_what_they_are() {
    let files = files_of(vec![sample::masking()]);
    let svg = text(&files, "plots/brdf-masking-error.svg");
    for row in ["smith-separable", "schlick-disney"] {
        assert_eq!(colours_of(&svg, row), [PAPER, DOMINATED], "{row}");
    }
    for row in ["implicit", "neumann", "schlick", "smith-correlated"] {
        assert_eq!(colours_of(&svg, row), [PAPER, FRONTIER], "{row}");
    }
    assert_eq!(colours_of(&svg, "cook-torrance"), [PAPER, FRONTIER, FAULT]);
    assert_eq!(colours_of(&svg, "reference"), [PAPER, DOMINATED, PAPER]);
    // Rounding alone makes no row useless where models differ.
    let svg = text(&files, "plots/brdf-masking-rounding.svg");
    assert_eq!(colours_of(&svg, "smith-hammon"), [PAPER, FRONTIER]);
    assert_eq!(colours_of(&svg, "smith-separable"), [PAPER, DOMINATED]);
    assert!(!svg.contains("on the frontier"));
    // Where they do not, it decides.
    let mut exact = sample::masking();
    exact.rows.iter_mut().for_each(|row| row.model = None);
    let svg = text(&files_of(vec![exact]), "plots/brdf-masking-rounding.svg");
    assert_eq!(colours_of(&svg, "smith-hammon"), [PAPER, DOMINATED]);
    assert_eq!(colours_of(&svg, "implicit"), [PAPER, FRONTIER]);
}

/// Catches a frontier that misses one of its rows or goes through a dominated one.
#[test]
fn the_frontier_goes_through_its_rows() {
    let svg = text(&files_of(vec![sample::masking()]), "plots/brdf-masking-error.svg");
    let document = Document::parse(&svg).expect("XML");
    let line = document
        .descendants()
        .find(|node| node.tag_name().name() == "polyline" && node.attribute("stroke") == Some(FRONTIER));
    let points = line.and_then(|node| node.attribute("points")).expect("a frontier");
    let points: Vec<[f64; 2]> = points
        .split_whitespace()
        .filter_map(|pair| pair.split_once(','))
        .map(|(x, y)| [x.parse().expect("x"), y.parse().expect("y")])
        .collect();
    assert!(points.is_sorted_by(|a, b| a[0] <= b[0] && a[1] <= b[1]), "{points:?}");
    for circle in circles(&svg).iter().filter(|circle| !circle.name.is_empty()) {
        assert_eq!(points.contains(&circle.at), !circle.name.contains("dominated"), "{circle:?}");
    }
}

/// Catches errors of 0 that are left out or drawn among the others, infinities alike, and a NaN that is drawn somewhere.
#[test]
fn every_row_with_a_number_has_a_point() {
    let files = files_of(vec![sample::hostile(), sample::masking()]);
    let svg = text(&files, "plots/b-evil-b-x-error.svg");
    let points: Vec<Circle> = circles(&svg).into_iter().filter(|circle| !circle.name.is_empty()).collect();
    let at = |name: &str| points.iter().find(|circle| circle.name.starts_with(name)).map(|circle| circle.at);
    assert_eq!(points.len(), 5, "{points:?}");
    assert_eq!(at("nan;"), None);
    let [infinite, tiny, one, nothing] =
        ["<script>", "tiny;", "one;", "nothing;"].map(|name| at(name).unwrap_or_else(|| panic!("no point {name}")));
    assert!(infinite[1] < one[1] && one[1] < tiny[1] && tiny[1] < nothing[1], "{points:?}");
    assert!(nothing[0] < tiny[0] && tiny[0] < one[0] && one[0] < infinite[0], "{points:?}");
    assert!(text(&files, "report.html").contains("Not drawn, since an error or a cost is no number: nan."));
    // All zeros stand on one line, below everything.
    let rows = vec![
        sample::row("reference", 400.0, None, 0.0),
        sample::row("exact", 300.0, Some(0.0), 0.0),
        sample::row("rough", 30.0, Some(0.1), 1e-6),
    ];
    let zeros = Results {
        name: "zeros".to_owned(),
        rows,
        ..sample::masking()
    };
    let svg = text(&files_of(vec![zeros]), "plots/zeros-error.svg");
    let low: Vec<String> = circles(&svg)
        .into_iter()
        .filter(|circle| !circle.name.is_empty() && circle.at[1] > 1430.0)
        .map(|circle| circle.name)
        .collect();
    assert_eq!(low.len(), 2, "{low:?}");
    assert!(
        low.iter()
            .any(|name| name.starts_with("reference;") && name.contains("it is the truth"))
    );
}

/// Catches a PNG that is drawn otherwise than the SVG: dots moved, or larger, or in another colour.
#[test]
fn both_forms_show_the_same_dots() {
    let rows = vec![
        sample::row("a", 3.0, Some(0.9), 1e-6),
        sample::row("b", 40.0, Some(0.1), 1e-6),
        sample::row("c", 500.0, Some(0.4), 1e-6),
        sample::row("d", 900.0, Some(0.0), 1e-6),
    ];
    let mut results = Results {
        name: "x".to_owned(),
        rows,
        ..Results::default()
    };
    sample::decide(&mut results);
    let files = files_of(vec![results]);
    let svg = circles(&text(&files, "plots/x-error.svg"));
    let png = picture(&files, "plots/x-error.png");
    let mut seen = 0;
    for dot in svg.iter().filter(|circle| circle.radius == 22.0) {
        seen += 1;
        let pixel = |across: f64, down: f64| {
            let [red, green, blue] = png.get_pixel((dot.at[0] / 2.0 + across) as u32, (dot.at[1] / 2.0 + down) as u32).0;
            format!("#{red:02X}{green:02X}{blue:02X}")
        };
        for [across, down] in [[0.0, 0.0], [9.0, 0.0], [-9.5, 0.0], [0.0, 9.0], [0.0, -9.5]] {
            assert_eq!(pixel(across, down), dot.fill, "{dot:?} {across} {down}");
        }
        for [across, down] in [[13.0, 0.5], [-13.5, 0.5], [0.5, 13.0], [0.5, -13.5]] {
            assert_ne!(pixel(across, down), dot.fill, "{dot:?} {across} {down}");
        }
    }
    // Four rows, and two in the legend.
    assert_eq!(seen, 6);
}

fn mapped(picture: Picture) -> BTreeMap<String, Vec<u8>> {
    let mut results = sample::lonely();
    results.rows[0].picture = Some(picture);
    files_of(vec![results])
}

/// The middle of a cell in the PNG of a picture of so many columns and rows: 288 pixels wide and high at (34, 36), two for each.
fn cell(png: &RgbImage, [columns, rows]: [usize; 2], [column, row]: [usize; 2]) -> [u8; 3] {
    let middle = |corner: f64, cells: usize, index: usize| {
        let side = (288.0 / cells as f64 * 2.0).floor() / 2.0;
        ((corner + (index as f64 + 0.5) * side) * 2.0) as u32
    };
    png.get_pixel(middle(34.0, columns, column), middle(36.0, rows, row)).0
}

fn luminance([red, green, blue]: [u8; 3]) -> f64 {
    0.2126 * f64::from(red) + 0.7152 * f64::from(green) + 0.0722 * f64::from(blue)
}

/// Catches a map with rows and columns exchanged or upside down, a scale the wrong way round, and cells that are not finite or 0 shown as errors.
#[test]
fn the_worst_cell_is_the_brightest() {
    let (columns, rows, worst) = (24, 16, [5, 13]);
    let error = |index: usize| {
        let away = (index % columns).abs_diff(worst[0]) + (index / columns).abs_diff(worst[1]);
        0.5 * 10.0_f64.powf(-(away as f64) / 4.0)
    };
    let mut errors: Vec<Option<f64>> = (0..columns * rows).map(|index| Some(error(index))).collect();
    errors[3] = None;
    errors[4] = Some(f64::INFINITY);
    errors[7] = Some(0.0);
    let files = mapped(Picture {
        width: columns,
        height: rows,
        errors,
        worst: worst.map(|place| place as f64),
        of: "model".to_owned(),
        ..Picture::default()
    });
    let png = picture(&files, "pictures/curve-exposure-manual-exact.png");
    let brightness = |place| luminance(cell(&png, [columns, rows], place));
    let all = (0..columns * rows).map(|index| [index % columns, index / columns]);
    let brightest = all.max_by(|a, b| brightness(*a).total_cmp(&brightness(*b)));
    assert_eq!(brightest, Some(worst));
    assert_eq!(cell(&png, [columns, rows], [3, 0]), [0xe0, 0x2d, 0x3c]);
    assert_eq!(cell(&png, [columns, rows], [4, 0]), [0xe0, 0x2d, 0x3c]);
    assert_eq!(cell(&png, [columns, rows], [7, 0]), [0, 0, 0]);
    // Farther away is darker, along the row.
    assert!(brightness([6, 13]) > brightness([12, 13]) && brightness([12, 13]) > brightness([20, 13]));
    // A ring is around the worst cell: white at 9 pixels from its middle, black beside.
    let [x, y] = [(34.0 + 5.5 * 12.0) * 2.0, (36.0 + 13.5 * 18.0) * 2.0];
    assert!(luminance(png.get_pixel((x + 18.0) as u32, y as u32).0) > 240.0);
    assert!(luminance(png.get_pixel((x + 21.0) as u32, y as u32).0) < 20.0);
}

/// Catches a picture of another size than its data, of none, and sizes whose product overflows.
#[test]
fn pictures_of_the_wrong_size_are_errors() {
    for (width, height, cells) in [(3, 2, 5), (0, 0, 0), (usize::MAX, 2, 4)] {
        let mut results = sample::lonely();
        results.rows[0].picture = Some(Picture {
            width,
            height,
            errors: vec![Some(1.0); cells],
            ..Picture::default()
        });
        let report = Report {
            experiments: vec![results],
            ..Report::default()
        };
        let error = files(&report).err().unwrap_or_else(|| panic!("{width} x {height} of {cells}"));
        assert!(matches!(error, WriteError::Picture { .. }));
        assert_eq!(
            error.to_string(),
            format!("curve/exposure/manual: the picture of `exact` should have {width} x {height} errors, not {cells}")
        );
    }
}

/// Catches drawings that no program can read, whatever their texts say.
#[test]
fn every_file_can_be_read() {
    let files = files(&sample::report()).expect("files");
    let mut kinds = BTreeMap::new();
    for (name, bytes) in &files {
        let ending = name.rsplit('.').next().unwrap_or_default();
        *kinds.entry(ending).or_insert(0) += 1;
        match ending {
            "svg" => {
                let text = std::str::from_utf8(bytes).expect("UTF-8");
                Document::parse(text).unwrap_or_else(|error| panic!("{name}: {error}"));
            }
            "png" => {
                let png = image::load_from_memory(bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
                assert!([(1120, 880), (824, 776)].contains(&(png.width(), png.height())), "{name}");
            }
            _ => {}
        }
    }
    assert_eq!(
        kinds,
        BTreeMap::from([("csv", 1), ("html", 1), ("json", 1), ("png", 8), ("svg", 4)])
    );
    let names: std::collections::BTreeSet<String> = files.iter().map(|(name, _)| name.to_lowercase()).collect();
    assert_eq!(names.len(), files.len());
}

/// Catches bytes that depend on time, on the order of a hash map or on what was drawn before.
#[test]
fn equal_reports_have_equal_files() {
    let report = sample::report();
    let first = files(&report).expect("files");
    files_of(vec![sample::lonely()]);
    let threads: Vec<_> = (0..2)
        .map(|_| {
            let report = report.clone();
            std::thread::spawn(move || files(&report).expect("files"))
        })
        .collect();
    for thread in threads {
        assert!(thread.join().expect("a thread") == first);
    }
}

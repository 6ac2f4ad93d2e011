//! One value, by its type, unit and range.

use eframe::egui::{self, DragValue, Response, Slider};
use shadewright_compiler::manifest::{KELVIN, Param, ParamType, Typed, Value, typed};

/// A range over more than this factor, or from 0 to more than this, is turned by its logarithm.
const WIDE: f64 = 100.0;
/// Where a range begins at 0, the logarithm begins at this share of its end.
const SMALLEST: f64 = 1e-5;

/// Shows a value; what somebody made of it.
pub(super) fn show(ui: &mut egui::Ui, label: &Response, name: &str, param: &Param, value: &Value) -> Option<Value> {
    // A value that is none of its parameter is shown as the default: the scene's own diagnostics say what is wrong.
    let typed = typed(param, value).or_else(|_| typed(param, &param.default)).ok()?;
    match typed {
        Typed::Bool(mut on) => ui.checkbox(&mut on, "").labelled_by(label.id).changed().then_some(Value::Bool(on)),
        Typed::F32(x) => number(ui, label, param, f64_of(x), false).map(Value::Number),
        Typed::U32(x) => number(ui, label, param, f64::from(x), true).map(Value::Number),
        Typed::I32(x) => number(ui, label, param, f64::from(x), true).map(Value::Number),
        Typed::Vec2(v) => vector(ui, name, param, &v),
        Typed::Vec3(v) if param.ty == ParamType::Color => color(ui, label, name, v, value),
        Typed::Vec3(v) => vector(ui, name, param, &v),
        Typed::Vec4(v) => vector(ui, name, param, &v),
    }
}

/// The shortest decimal that is this number: what people wrote.
fn f64_of(x: f32) -> f64 {
    x.to_string().parse().unwrap_or(f64::from(x))
}

fn suffix(param: &Param) -> String {
    match param.unit.as_str() {
        "" | "1" => String::new(),
        unit => format!(" {unit}"),
    }
}

fn number(ui: &mut egui::Ui, label: &Response, param: &Param, value: f64, is_whole: bool) -> Option<f64> {
    let mut new = value;
    let response = match param.range {
        Some((low, high)) if high - low < 1e7 => {
            let is_wide = if low > 0.0 { high / low > WIDE } else { low == 0.0 && high >= WIDE };
            let mut slider = Slider::new(&mut new, low..=high).suffix(suffix(param));
            if is_whole {
                slider = slider.integer();
            } else if is_wide {
                slider = slider.logarithmic(true).smallest_positive(low.max(high * SMALLEST));
            }
            ui.add(slider)
        }
        range => ui.add(drag(&mut new, param, range, is_whole)),
    };
    response.labelled_by(label.id).changed().then_some(new)
}

/// A number that is dragged, at a pace that suits its size.
fn drag<'v>(value: &'v mut f64, param: &Param, range: Option<(f64, f64)>, is_whole: bool) -> DragValue<'v> {
    let speed = if is_whole { 0.1 } else { (value.abs() * 0.01).max(0.005) };
    let mut drag = DragValue::new(value).speed(speed).suffix(suffix(param));
    if let Some((low, high)) = range {
        drag = drag.range(low..=high);
    }
    if is_whole { drag.max_decimals(0) } else { drag }
}

fn vector(ui: &mut egui::Ui, name: &str, param: &Param, v: &[f32]) -> Option<Value> {
    let mut new: Vec<f64> = v.iter().map(|x| f64_of(*x)).collect();
    let mut changed = false;
    ui.horizontal(|ui| {
        for (index, x) in new.iter_mut().enumerate() {
            let response = ui.add(drag(x, param, param.range, false));
            let component = ["x", "y", "z", "w"][index % 4];
            let accessible = format!("{name}.{component}");
            let shown = *x;
            response.widget_info(|| egui::WidgetInfo {
                label: Some(accessible.clone()),
                ..egui::WidgetInfo::drag_value(true, shown)
            });
            changed |= response.changed();
        }
    });
    changed.then_some(Value::List(new))
}

/// A colour: linear, by hand or by the temperature of what shines.
fn color(ui: &mut egui::Ui, label: &Response, name: &str, rgb: [f32; 3], value: &Value) -> Option<Value> {
    let mut new = rgb;
    let mut result = None;
    ui.horizontal(|ui| {
        let response = ui.color_edit_button_rgb(&mut new).labelled_by(label.id);
        let accessible = name.to_owned();
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ColorWell, true, &accessible));
        if response.changed() {
            result = Some(Value::List(new.iter().map(|x| f64_of(*x)).collect()));
        }
        let kelvin = match value {
            Value::Text(text) => text.split_whitespace().next().and_then(|number| number.parse::<f64>().ok()),
            _ => None,
        };
        let mut temperature = kelvin.unwrap_or(6500.0);
        let drag = DragValue::new(&mut temperature)
            .speed(20.0)
            .range(*KELVIN.start()..=*KELVIN.end())
            .max_decimals(0)
            .suffix(" K");
        // A colour that is none of a black body has no temperature to show.
        let drag = if kelvin.is_none() {
            drag.custom_formatter(|_, _| String::new())
        } else {
            drag
        };
        let response = ui.add(drag);
        let accessible = format!("{name} temperature");
        response.widget_info(|| egui::WidgetInfo {
            label: Some(accessible.clone()),
            ..egui::WidgetInfo::drag_value(true, temperature)
        });
        let response = if kelvin.is_none() {
            response.on_hover_text("A black body of this temperature instead")
        } else {
            response
        };
        if response.changed() {
            result = Some(Value::Text(format!("{temperature:.0} K")));
        }
    });
    result
}

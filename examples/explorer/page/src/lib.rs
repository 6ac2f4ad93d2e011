//! The explorer as a web page: the same application on a canvas, with its scene in the page's address.

#![cfg(target_arch = "wasm32")]
#![forbid(unsafe_code)]

mod address;

use eframe::egui;
use explorer::{App, Start, scenes};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;
use web_sys::HtmlCanvasElement;

use address::Address;

/// The application, and the address that follows it.
struct Page {
    app: App,
    address: Address,
}

impl eframe::App for Page {
    fn logic(&mut self, context: &egui::Context, frame: &mut eframe::Frame) {
        self.address.follow(&mut self.app, context);
        self.app.logic(context, frame);
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.app.ui(ui, frame);
    }
}

/// Starts the explorer on a canvas, with the scene that the page's address names.
///
/// # Errors
/// There is no GPU that the page may use.
#[wasm_bindgen]
pub async fn start(canvas: HtmlCanvasElement) -> Result<(), JsValue> {
    eframe::WebLogger::init(log::LevelFilter::Warn).ok();
    let mut options = eframe::WebOptions::default();
    options.wgpu_options.wgpu_setup = explorer::setup();
    eframe::WebRunner::new()
        .start(
            canvas,
            options,
            Box::new(|context| {
                let render_state = context.wgpu_render_state.clone().ok_or("the page has no GPU")?;
                // There before anything else: what the address says instead is opened by its first frame.
                let scene = scenes::ALL[0].scene().map_err(|report| report.render())?;
                let app = App::new(&context.egui_ctx, render_state, Start::with(scene)).map_err(|report| report.render())?;
                let address = Address::new(&context.egui_ctx).map_err(|error| format!("{error:?}"))?;
                Ok(Box::new(Page { app, address }))
            }),
        )
        .await
}

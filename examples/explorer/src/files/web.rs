//! Files of a page: given to it by a drop or in the browser's own dialog, and taken from it as downloads.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui;
use egui::DroppedFileHandle;
use js_sys::{Array, Uint8Array};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{Blob, Document, File, HtmlAnchorElement, HtmlInputElement, Url};

use crate::App;

/// What was given at once: names and bytes, or why there are none.
type Given = Result<Vec<(String, Vec<u8>)>, String>;

/// Files that a page was given, once the browser has read them. Clones are the same.
#[derive(Clone, Default)]
pub(crate) struct Inbox(Arc<Mutex<Vec<Given>>>);

impl Inbox {
    fn put(&self, given: Given, context: &egui::Context) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(given);
        context.request_repaint();
    }

    /// What has been read.
    fn take(&self) -> Vec<Given> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Has files read that were dropped on the page.
    pub fn receive(&self, dropped: Vec<DroppedFileHandle>, context: &egui::Context) {
        if dropped.is_empty() {
            return;
        }
        let (inbox, context) = (self.clone(), context.clone());
        spawn_local(async move {
            let mut given = Ok(Vec::new());
            for file in dropped {
                let bytes = file.bytes_async().await;
                given = together(given, file.path().display().to_string(), bytes);
            }
            inbox.put(given, &context);
        });
    }

    /// Opens the browser's dialog, and has the files read that are chosen in it.
    ///
    /// # Errors
    /// The browser refuses.
    pub fn ask(&self, context: &egui::Context) -> Result<(), JsValue> {
        let input: HtmlInputElement = document()?.create_element("input")?.unchecked_into();
        input.set_type("file");
        input.set_multiple(true);
        let (inbox, context, asked) = (self.clone(), context.clone(), input.clone());
        let chosen = Closure::once_into_js(move || {
            let files = asked.files();
            spawn_local(async move {
                let mut given = Ok(Vec::new());
                for file in files
                    .iter()
                    .flat_map(|files| (0..files.length()).filter_map(|index| files.get(index)))
                {
                    let bytes = read(&file).await.map_err(|error| said(&error));
                    given = together(given, file.name(), bytes);
                }
                inbox.put(given, &context);
            });
        });
        input.set_onchange(Some(chosen.unchecked_ref()));
        input.click();
        Ok(())
    }
}

impl App {
    /// Opens what the page was given. Files that were given together may name each other.
    pub(crate) fn take_inbox(&mut self) {
        for given in self.inbox.take() {
            match given {
                Ok(given) => self.take_given(given),
                Err(why) => self.message = why,
            }
        }
    }

    fn take_given(&mut self, given: Vec<(String, Vec<u8>)>) {
        let mut files = self.document.scene().files().clone();
        let mut names = Vec::new();
        for (name, bytes) in given {
            files = files.with(name.as_str(), bytes);
            names.push(name);
        }
        self.document.use_files(files);
        // What names others is what was meant.
        let names_others = |name: &String| {
            let name = name.to_lowercase();
            [".ron", ".gltf", ".glb"].iter().any(|end| name.ends_with(end))
        };
        let opened = names.iter().find(|name| names_others(name)).or(names.first());
        if let Some(name) = opened {
            self.open_file(Path::new(name).to_owned());
        }
    }
}

fn together(given: Given, name: String, bytes: Result<Vec<u8>, String>) -> Given {
    let mut all = given?;
    let bytes = bytes.map_err(|why| format!("{name}: {why}"))?;
    all.push((name, bytes));
    Ok(all)
}

async fn read(file: &File) -> Result<Vec<u8>, JsValue> {
    let buffer = JsFuture::from(file.array_buffer()).await?;
    Ok(Uint8Array::new(&buffer).to_vec())
}

/// Offers bytes as a download.
///
/// # Errors
/// The browser refuses.
pub(crate) fn download(name: &str, bytes: &[u8]) -> Result<(), JsValue> {
    let blob = Blob::new_with_u8_array_sequence(&Array::of1(&Uint8Array::from(bytes)))?;
    let address = Url::create_object_url_with_blob(&blob)?;
    let link: HtmlAnchorElement = document()?.create_element("a")?.unchecked_into();
    link.set_href(&address);
    link.set_download(name);
    link.click();
    // The download may begin after this; what it needs is given back when it surely has.
    let forget = Closure::once_into_js(move || {
        if let Err(error) = Url::revoke_object_url(&address) {
            log::debug!("{}", said(&error));
        }
    });
    let window = web_sys::window().ok_or("no window")?;
    window.set_timeout_with_callback_and_timeout_and_arguments_0(forget.unchecked_ref(), 60_000)?;
    Ok(())
}

fn document() -> Result<Document, JsValue> {
    let window = web_sys::window();
    window
        .and_then(|window| window.document())
        .ok_or_else(|| JsValue::from_str("no document"))
}

/// What a browser's error says.
pub(crate) fn said(error: &JsValue) -> String {
    let text = error.dyn_ref::<js_sys::Error>().map(|error| String::from(error.message()));
    text.or_else(|| error.as_string()).unwrap_or_else(|| format!("{error:?}"))
}

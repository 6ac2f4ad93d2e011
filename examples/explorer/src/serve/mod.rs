//! The explorer as a web page: built with the tools that there are, and served to the browsers of this machine.
//!
//! ```text
//! explorer-page -> cargo, for wasm32 -> wasm-bindgen -> Site -> serve
//! ```

mod build;
mod http;

use std::io::Write;
use std::net::TcpListener;

pub use build::{BuildError, Site, build};
pub use http::{Response, serve};

/// Builds the page and serves it until the program is ended. Port 0 takes one that is free.
///
/// # Errors
/// It cannot be built, or the port is taken.
pub fn run(port: u16) -> Result<(), String> {
    let site = build().map_err(|error| error.to_string())?;
    let taken = |error| format!("port {port}: {error}; --port 0 takes one that is free");
    let listener = TcpListener::bind(("127.0.0.1", port)).map_err(taken)?;
    let address = listener.local_addr().map_err(taken)?;
    // Nobody may be there to read it.
    let _ = writeln!(
        std::io::stdout(),
        "The explorer is at http://localhost:{}/ (its files are in {}). Ctrl+C ends it.",
        address.port(),
        site.folder.display()
    );
    serve(&listener, |path| site.respond(path));
    Ok(())
}

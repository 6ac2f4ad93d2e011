//! Bytes that a glTF file refers to: its own chunk, data URIs, files beside it.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use base64::Engine;

use super::{GltfError, Read, damaged, unsupported};

/// Reads a file.
pub(super) fn read(path: &Path, by: &mut Read) -> Result<Vec<u8>, GltfError> {
    by(path).map_err(|why| GltfError::Unreadable {
        path: path.to_owned(),
        why,
    })
}

/// The bytes behind a URI.
pub(super) fn resolve(uri: &str, folder: &Path, place: &str, by: &mut Read) -> Result<Vec<u8>, GltfError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let Some((head, body)) = data.split_once(',') else {
            return Err(damaged(place, "a data URI without a comma"));
        };
        if !head.ends_with(";base64") {
            return Err(unsupported(place, "a data URI that is not base64"));
        }
        return base64::engine::general_purpose::STANDARD
            .decode(body)
            .map_err(|e| damaged(place, format!("base64: {e}")));
    }
    let path = unescape(uri).ok_or_else(|| damaged(place, "a URI with broken percent escapes"))?;
    let path = PathBuf::from(path.as_ref());
    // A scheme, or a path from the root, would reach outside what came with the file.
    if path.is_absolute() || uri.contains(':') || uri.starts_with(['/', '\\']) {
        return Err(unsupported(
            place,
            format!("the reference `{}`, which is not relative,", shortened(uri)),
        ));
    }
    read(&folder.join(path), by)
}

fn shortened(uri: &str) -> String {
    let mut text: String = uri.chars().take(60).collect();
    if text.len() < uri.len() {
        text.push_str("...");
    }
    text
}

/// Replaces `%20` and its like; `None` if what comes out is no UTF-8 or an escape is cut.
fn unescape(uri: &str) -> Option<Cow<'_, str>> {
    if !uri.contains('%') {
        return Some(Cow::Borrowed(uri));
    }
    let mut out = Vec::with_capacity(uri.len());
    let mut bytes = uri.bytes();
    while let Some(byte) = bytes.next() {
        if byte == b'%' {
            let mut digit = || bytes.next().and_then(|b| char::from(b).to_digit(16));
            let (high, low) = (digit()?, digit()?);
            out.push((high * 16 + low) as u8);
        } else {
            out.push(byte);
        }
    }
    String::from_utf8(out).ok().map(Cow::Owned)
}

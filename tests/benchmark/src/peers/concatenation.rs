//! No composition at all: the modules' texts behind each other. It works here because the names were made unique before.

use crate::pieces::Piece;

/// All pieces as one text.
pub fn concatenate(pieces: &[Piece]) -> String {
    pieces.iter().map(Piece::text).collect()
}

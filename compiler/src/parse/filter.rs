//! Sets of words that can be asked quickly.

/// A set of words that may say yes wrongly, but never no: some times as many bits as a library's texts have words.
#[derive(Clone, Debug)]
pub struct Filter(Vec<u64>);

impl Default for Filter {
    fn default() -> Self {
        Self(vec![0; 1 << (Self::BITS - 6)])
    }
}

impl Filter {
    /// Binary logarithm of the number of bits.
    const BITS: u32 = 15;

    /// Puts a word in, by its hash.
    pub fn insert(&mut self, hash: u64) {
        let (at, bit) = Self::place(hash);
        self.0[at] |= bit;
    }

    /// Whether a word of this hash may be in.
    pub fn may_have(&self, hash: u64) -> bool {
        let (at, bit) = Self::place(hash);
        self.0[at] & bit != 0
    }

    /// The hash is a product: its upper bits are the good ones.
    fn place(hash: u64) -> (usize, u64) {
        let bit = (hash >> (u64::BITS - Self::BITS)) as usize;
        (bit / 64, 1 << (bit % 64))
    }
}

/// A quick hash of a word, the same on every machine.
pub fn word_hash(word: &str) -> u64 {
    word.as_bytes().chunks(8).fold(0, |hash: u64, chunk| {
        let mut bytes = [0; 8];
        bytes[..chunk.len()].copy_from_slice(chunk);
        (hash.rotate_left(5) ^ u64::from_le_bytes(bytes)).wrapping_mul(0x9E37_79B9_7F4A_7C15)
    })
}

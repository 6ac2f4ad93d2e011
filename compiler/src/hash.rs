//! A hash of what a module means, apart from how things in it are called.
//!
//! The module's own serialised form (naga derives it, so nothing can be forgotten when naga's IR grows) is fed to SipHash-1-3 with
//! 128 bits instead of being written. Left out are the names of types, members, constants, variables, functions and expressions,
//! documentation comments and diagnostic filters; spans are not in that form. Kept are the names that a host uses: those of entry
//! points and overrides.
//!
//! Handles are hashed as they are, so two modules that mean the same have one hash only if their arenas are in one order: the
//! linker's, which places what is reached from the entry points depth-first.

use std::fmt::Display;
use std::hash::Hasher;

use serde::Serialize;
use serde::ser::{self, Serializer};
use siphasher::sip128::{Hasher128, SipHasher13};

/// Hash of a module's structure, the same on every machine and in every run. See the module's documentation for what counts.
pub fn structural_hash(module: &naga::Module) -> u128 {
    let mut feed = Feed(SipHasher13::new());
    if let Err(error) = module.serialize(&mut feed) {
        // naga's derived serialisation raises no errors of its own, and ours takes everything.
        feed.text(&error.0);
    }
    feed.finish()
}

/// Fields that say nothing about what a module does, wherever they stand.
const LEFT_OUT: [&str; 4] = ["named_expressions", "doc_comments", "diagnostic_filters", "diagnostic_filter_leaf"];
/// Structs whose field `name` a host uses.
const NAMED: [&str; 2] = ["EntryPoint", "Override"];

/// Takes values in a form in which different values are different bytes.
struct Feed(SipHasher13);

impl Feed {
    fn finish(&self) -> u128 {
        let hash = self.0.finish128();
        u128::from(hash.h1) | u128::from(hash.h2) << 64
    }

    fn tag(&mut self, tag: u8) {
        self.0.write(&[tag]);
    }

    fn text(&mut self, text: &str) {
        self.bytes(text.as_bytes());
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.0.write(&(bytes.len() as u64).to_le_bytes());
        self.0.write(bytes);
    }

    /// Before each element of a list or map.
    fn element(&mut self) {
        self.tag(1);
    }

    /// After the last one.
    fn end(&mut self) {
        self.tag(0);
    }
}

/// What serde wants serialisation to fail with.
#[derive(Debug)]
struct Failure(String);

impl Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Failure {}

impl ser::Error for Failure {
    fn custom<T: Display>(message: T) -> Self {
        Self(message.to_string())
    }
}

macro_rules! numbers {
    ($($method:ident: $type:ty;)*) => {
        $(fn $method(self, value: $type) -> Result<(), Failure> {
            self.0.write(&value.to_le_bytes());
            Ok(())
        })*
    };
}

impl<'f> Serializer for &'f mut Feed {
    type Ok = ();
    type Error = Failure;
    type SerializeSeq = Self;
    type SerializeTuple = Self;
    type SerializeTupleStruct = Self;
    type SerializeTupleVariant = Self;
    type SerializeMap = Self;
    type SerializeStruct = Fields<'f>;
    type SerializeStructVariant = Fields<'f>;

    numbers! {
        serialize_i8: i8; serialize_i16: i16; serialize_i32: i32; serialize_i64: i64; serialize_i128: i128;
        serialize_u8: u8; serialize_u16: u16; serialize_u32: u32; serialize_u64: u64; serialize_u128: u128;
        serialize_f32: f32; serialize_f64: f64;
    }

    fn serialize_bool(self, value: bool) -> Result<(), Failure> {
        self.tag(u8::from(value));
        Ok(())
    }

    fn serialize_char(self, value: char) -> Result<(), Failure> {
        self.serialize_u32(u32::from(value))
    }

    fn serialize_str(self, value: &str) -> Result<(), Failure> {
        self.text(value);
        Ok(())
    }

    fn serialize_bytes(self, value: &[u8]) -> Result<(), Failure> {
        self.bytes(value);
        Ok(())
    }

    fn serialize_none(self) -> Result<(), Failure> {
        self.tag(0);
        Ok(())
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), Failure> {
        self.tag(1);
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<(), Failure> {
        Ok(())
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<(), Failure> {
        Ok(())
    }

    fn serialize_unit_variant(self, _: &'static str, index: u32, _: &'static str) -> Result<(), Failure> {
        self.serialize_u32(index)
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Result<(), Failure> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        index: u32,
        _: &'static str,
        value: &T,
    ) -> Result<(), Failure> {
        self.serialize_u32(index)?;
        value.serialize(self)
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Self, Failure> {
        Ok(self)
    }

    fn serialize_tuple(self, _: usize) -> Result<Self, Failure> {
        Ok(self)
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self, Failure> {
        Ok(self)
    }

    fn serialize_tuple_variant(self, _: &'static str, index: u32, _: &'static str, _: usize) -> Result<Self, Failure> {
        self.serialize_u32(index)?;
        Ok(self)
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Self, Failure> {
        Ok(self)
    }

    fn serialize_struct(self, name: &'static str, _: usize) -> Result<Fields<'f>, Failure> {
        Ok(Fields {
            feed: self,
            named: NAMED.contains(&name),
        })
    }

    fn serialize_struct_variant(self, _: &'static str, index: u32, _: &'static str, _: usize) -> Result<Fields<'f>, Failure> {
        self.serialize_u32(index)?;
        // No variant of naga's has a name that is only a name.
        Ok(Fields { feed: self, named: true })
    }
}

macro_rules! elements {
    ($($trait:ident: $method:ident;)*) => {
        $(impl ser::$trait for &mut Feed {
            type Ok = ();
            type Error = Failure;

            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Failure> {
                self.element();
                value.serialize(&mut **self)
            }

            fn end(self) -> Result<(), Failure> {
                Feed::end(self);
                Ok(())
            }
        })*
    };
}

elements! {
    SerializeSeq: serialize_element;
    SerializeTuple: serialize_element;
    SerializeTupleStruct: serialize_field;
    SerializeTupleVariant: serialize_field;
}

impl ser::SerializeMap for &mut Feed {
    type Ok = ();
    type Error = Failure;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Failure> {
        self.element();
        key.serialize(&mut **self)
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Failure> {
        value.serialize(&mut **self)
    }

    fn end(self) -> Result<(), Failure> {
        Feed::end(self);
        Ok(())
    }
}

/// The fields of one struct. Their number and order belong to its type, so they need no tags.
struct Fields<'f> {
    feed: &'f mut Feed,
    named: bool,
}

impl Fields<'_> {
    fn field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Failure> {
        if LEFT_OUT.contains(&key) || key == "name" && !self.named {
            return Ok(());
        }
        value.serialize(&mut *self.feed)
    }
}

impl ser::SerializeStruct for Fields<'_> {
    type Ok = ();
    type Error = Failure;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Failure> {
        self.field(key, value)
    }

    fn end(self) -> Result<(), Failure> {
        Ok(())
    }
}

impl ser::SerializeStructVariant for Fields<'_> {
    type Ok = ();
    type Error = Failure;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Failure> {
        self.field(key, value)
    }

    fn end(self) -> Result<(), Failure> {
        Ok(())
    }
}

#[cfg(test)]
mod tests;

//! Speed against error: experiments on modules, and the report of their results.
#![forbid(unsafe_code)]

pub mod data;
pub mod write;

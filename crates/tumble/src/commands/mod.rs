//! One file a command.

pub(crate) mod catalogue;
pub(crate) mod certify;
pub(crate) mod compensate;
pub(crate) mod simulate;

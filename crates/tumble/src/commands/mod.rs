//! One file a command.

pub(crate) mod catalogue;
pub(crate) mod certify;
pub(crate) mod check;
pub(crate) mod compensate;
pub(crate) mod completions;
pub(crate) mod explain;
pub(crate) mod init;
pub(crate) mod man;
pub(crate) mod noise;
pub(crate) mod plan;
pub(crate) mod simulate;

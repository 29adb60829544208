//! Small dense linear algebra for least squares with few columns: orthogonal transformations only, so that
//! narrow arcs (condition numbers of 1e5 and more) lose no more digits than they must.

mod double;
mod jacobi;
mod matrix;
mod symmetric;
mod triangular;

pub use jacobi::{SingularValues, singular_values};
pub use matrix::Matrix;
pub use symmetric::{Symmetric3, dot3};
pub use triangular::{RANK_CONDITION_LIMIT, RankDeficient, Triangular};

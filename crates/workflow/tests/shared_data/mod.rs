//! Real files, where there are any.

use crate::outside;

#[allow(unused_imports, reason = "each test uses a part")]
pub(crate) use outside::{python_with, shared};

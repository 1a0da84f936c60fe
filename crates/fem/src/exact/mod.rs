//! Closed-form solutions, against which the elements are tested and examples can be judged.
//!
//! Time convention e^{+iωt}; a hysteretic material has the complex modulus E = E′(1 + iη).

pub mod beam;
pub mod plate;
pub mod rod;

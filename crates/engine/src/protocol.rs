//! Requests to `frfit-mumps` and its outcomes, byte by byte. All numbers are little endian.
//!
//! Each request is 32 bytes and what belongs to it; each outcome is 24 bytes and what belongs to it. The other side
//! is `engines/mumps/frfit-mumps.c`.

use frfit_linalg::solve::Breakdown;
use frfit_linalg::{Scalar, c64};

/// The version that both sides speak.
pub(crate) const VERSION: u32 = 1;
/// Characters of the token that the caller shows.
pub(crate) const TOKEN: usize = 64;
/// Bytes of the greeting: token, version, ranks, version of MUMPS.
pub(crate) const GREETING: usize = TOKEN + 8 + 24;
/// Bytes of the folder for factors out of core, its final zero included.
pub(crate) const FOLDER: usize = 256;

/// What a request asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Verb {
    Settings = 1,
    Pattern,
    Forecast,
    Factor,
    Solve,
    ForgetFactor,
    ForgetPattern,
    Usage,
    End,
}

/// A request. What it does not need is zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Request {
    pub(crate) verb: Verb,
    pub(crate) scalar: u32,
    pub(crate) pattern: u32,
    pub(crate) factor: u32,
    /// Rows of a pattern, or columns of a block of right-hand sides.
    pub(crate) size: usize,
    pub(crate) entries: usize,
}

impl Request {
    pub(crate) fn new(verb: Verb) -> Self {
        Self { verb, scalar: 0, pattern: 0, factor: 0, size: 0, entries: 0 }
    }

    pub(crate) fn bytes(&self) -> [u8; 32] {
        let mut bytes = [0; 32];
        let short = [self.verb as u32, self.scalar, self.pattern, self.factor];
        for (place, number) in bytes.chunks_exact_mut(4).zip(short) {
            place.copy_from_slice(&number.to_le_bytes());
        }
        for (place, number) in bytes[16..].chunks_exact_mut(8).zip([self.size, self.entries]) {
            place.copy_from_slice(&(number as u64).to_le_bytes());
        }
        bytes
    }
}

/// What came of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Outcome {
    /// INFOG(1) of MUMPS: negative for an error.
    pub(crate) code: i32,
    /// INFOG(2).
    pub(crate) detail: i32,
    /// Eigenvalues below zero; negative: not counted.
    pub(crate) negative: i64,
    /// What a factor needs on the machine where it needs the largest part of what is free; of a forecast.
    pub(crate) bytes: i64,
}

/// Bytes of an outcome.
pub(crate) const OUTCOME: usize = 24;

impl Outcome {
    pub(crate) fn of(bytes: &[u8; OUTCOME]) -> Self {
        Self { code: at(bytes, 0), detail: at(bytes, 4), negative: at(bytes, 8), bytes: at(bytes, 16) }
    }

    /// The codes of MUMPS as outcomes of ours (users' guide of 5.5, section 8).
    pub(crate) fn check(self) -> Result<Self, Breakdown> {
        match self.code {
            0.. => Ok(self),
            -10 => Err(Breakdown::Singular { condition_at_least: f64::INFINITY }),
            -5 | -7 | -8 | -9 | -11 | -13 | -14 | -17 | -19 | -20 => Err(Breakdown::OutOfMemory),
            -90 => Err(Breakdown::Engine(
                "mumps: a factor could not be written to the folder for factors".into(),
            )),
            code => Err(Breakdown::Engine(format!("mumps: INFOG(1) = {code}, INFOG(2) = {}", self.detail))),
        }
    }
}

/// The number that begins at a byte.
pub(crate) fn at<T: Wire>(bytes: &[u8], place: usize) -> T {
    T::get(&bytes[place..])
}

/// What a rank has used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RankUsage {
    /// Its largest memory so far, in bytes.
    pub peak_bytes: f64,
    /// CPU time, in seconds.
    pub cpu_s: f64,
}

/// A number as it goes over the wire.
pub(crate) trait Wire: Copy {
    const BYTES: usize;
    fn put(self, to: &mut Vec<u8>);
    fn get(from: &[u8]) -> Self;
}

macro_rules! wire {
    ($($number:ty),*) => {$(
        impl Wire for $number {
            const BYTES: usize = size_of::<Self>();

            fn put(self, to: &mut Vec<u8>) {
                to.extend(self.to_le_bytes());
            }

            fn get(from: &[u8]) -> Self {
                Self::from_le_bytes(from[..Self::BYTES].try_into().expect("as many bytes"))
            }
        }
    )*};
}

wire!(u32, i32, i64, f64);

impl Wire for c64 {
    const BYTES: usize = 2 * f64::BYTES;

    fn put(self, to: &mut Vec<u8>) {
        self.re.put(to);
        self.im.put(to);
    }

    fn get(from: &[u8]) -> Self {
        Self::new(at(from, 0), at(from, f64::BYTES))
    }
}

/// The two scalars of a factor, as requests name them.
pub(crate) trait Named: Scalar + Wire {
    const SCALAR: u32;
}

impl Named for f64 {
    const SCALAR: u32 = 0;
}

impl Named for c64 {
    const SCALAR: u32 = 1;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_is_as_the_ranks_read_it() {
        let request = Request { pattern: 7, size: 3, entries: 1 << 33, ..Request::new(Verb::Pattern) };
        let bytes = request.bytes();
        assert_eq!([0, 4, 8, 12].map(|place| at::<u32>(&bytes, place)), [2, 0, 7, 0]);
        assert_eq!([16, 24].map(|place| at::<i64>(&bytes, place)), [3, 1 << 33]);
    }

    #[test]
    fn codes_become_outcomes() {
        let of = |code| Outcome { code, detail: 5, negative: -1, bytes: 0 }.check();
        assert!(of(0).is_ok() && of(1).is_ok());
        assert!(matches!(of(-10), Err(Breakdown::Singular { .. })));
        assert_eq!(of(-13), Err(Breakdown::OutOfMemory));
        assert_eq!(of(-3), Err(Breakdown::Engine("mumps: INFOG(1) = -3, INFOG(2) = 5".into())));
    }
}

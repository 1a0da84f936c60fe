//! The numbers of a matrix: real or complex, double or single.

use crate::{Factor, FactorError, Options, Symbolic, Threads};
use num_complex::Complex;
use pulp::Simd;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// Double complex.
#[expect(non_camel_case_types, reason = "the name that numerical libraries give it")]
pub type c64 = Complex<f64>;
/// Single complex.
#[expect(non_camel_case_types, reason = "the name that numerical libraries give it")]
pub type c32 = Complex<f32>;

/// `f32` or `f64`, with the vector registers of an instruction set.
pub trait Real: Scalar<Real = Self> + PartialOrd + Into<f64> + pulp::bytemuck::Pod {
    /// A register full of them.
    type Vector<S: Simd>: Copy;
    /// Unit roundoff.
    const ROUNDOFF: f64;
    /// How many there are in a register.
    fn lanes<S: Simd>() -> usize;
    /// |x|.
    fn absolute(self) -> Self;
    /// The nearest to a double.
    fn from_f64(value: f64) -> Self;
    /// The same number in every lane.
    fn splat<S: Simd>(simd: S, value: Self) -> Self::Vector<S>;
    /// a·b + c.
    fn mul_add<S: Simd>(
        simd: S,
        a: Self::Vector<S>,
        b: Self::Vector<S>,
        c: Self::Vector<S>,
    ) -> Self::Vector<S>;
    /// Sum of the lanes.
    fn sum<S: Simd>(simd: S, a: Self::Vector<S>) -> Self;
    /// Whole registers, and the rest.
    fn vectors<S: Simd>(values: &[Self]) -> (&[Self::Vector<S>], &[Self]);
    /// Whole registers, and the rest.
    fn vectors_mut<S: Simd>(values: &mut [Self]) -> (&mut [Self::Vector<S>], &mut [Self]);
    /// The first numbers of a register, zeros behind them.
    fn load_part<S: Simd>(simd: S, values: &[Self]) -> Self::Vector<S>;
    /// Stores the first numbers of a register.
    fn store_part<S: Simd>(simd: S, values: &mut [Self], vector: Self::Vector<S>);
}

/// A number of a symmetric matrix: [`f64`], [`c64`], or in single precision [`f32`], [`c32`].
///
/// Sealed: there are no others, and what they need beyond this is no part of the interface.
pub trait Scalar:
    Number
    + Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// 1.
    const ONE: Self;
    /// |z|.
    fn modulus(self) -> f64;
    /// re − i im.
    fn conjugate(self) -> Self;
    /// Neither infinite nor not a number.
    fn is_finite(self) -> bool;
}

/// What the algorithms need of a number. In a module that nobody else can name: so there are no other scalars.
pub trait Number: Copy {
    /// What its parts are.
    type Real: Real;
    /// The same in single precision.
    type Single: Scalar;
    /// Real and imaginary part.
    const PARTS: usize;
    /// Real products that one product takes: 1, or 3 for a complex one.
    ///
    /// (a + ib)(c + id) = ac − bd + i((a+b)(c+d) − ac − bd). Its error is small against |a+ib||c+id|, as an
    /// elimination's is anyway, not against each part.
    ///
    /// # Source
    /// N. J. Higham, SIAM J. Matrix Anal. Appl. 13 (1992) 681–687.
    const PRODUCTS: usize;
    /// A number without imaginary part.
    fn from_real(real: Self::Real) -> Self;
    /// From its parts; a real number has the first.
    fn from_parts(parts: [Self::Real; 2]) -> Self;
    /// Real and imaginary part.
    fn parts(self) -> [Self::Real; 2];
    /// Its factors in the real products.
    fn factors(self) -> [Self::Real; 3];
    /// The product from the real products.
    fn from_products(products: [Self::Real; 3]) -> Self;
    /// |re| + |im|: the modulus but for a factor of √2, without a root.
    fn size(self) -> f64;
    /// Product with a real number.
    fn scale(self, by: Self::Real) -> Self;
    /// Rounded to single precision.
    fn to_single(self) -> Self::Single;
    /// From single precision.
    fn from_single(single: Self::Single) -> Self;
    /// Whether it is negative: a complex number never is.
    fn is_negative(self) -> bool;
    /// [`Symbolic::factor`], compiled here once and not again wherever it is used: it is nearly all of the code.
    fn factor(symbolic: &Symbolic, values: &[Self], options: &Options) -> Result<Factor<Self>, FactorError>
    where
        Self: Scalar;
    /// [`Factor::solve_in_place`], compiled here once.
    fn solve(factor: &Factor<Self>, rhs: &mut [Self], threads: Threads)
    where
        Self: Scalar;
}

/// sum + v x for numbers v and one number x: v and the sum in registers of real and of imaginary parts.
#[inline(always)]
pub(crate) fn add_product<T: Scalar, S: Simd>(
    simd: S,
    [re, im]: [<T::Real as Real>::Vector<S>; 2],
    [x, y]: [T::Real; 2],
    [sum_re, sum_im]: [<T::Real as Real>::Vector<S>; 2],
) -> [<T::Real as Real>::Vector<S>; 2] {
    let (minus, x) = (T::Real::splat(simd, -y), T::Real::splat(simd, x));
    let sum_re = T::Real::mul_add(simd, re, x, sum_re);
    if T::PARTS == 1 {
        return [sum_re, sum_im];
    }
    let sum_im = T::Real::mul_add(simd, re, T::Real::splat(simd, y), sum_im);
    [T::Real::mul_add(simd, im, minus, sum_re), T::Real::mul_add(simd, im, x, sum_im)]
}

macro_rules! compiled_here {
    () => {
        fn factor(
            symbolic: &Symbolic,
            values: &[Self],
            options: &Options,
        ) -> Result<Factor<Self>, FactorError> {
            crate::factor::factor(symbolic, values, options)
        }
        fn solve(factor: &Factor<Self>, rhs: &mut [Self], threads: Threads) {
            crate::solve::solve(factor, rhs, threads);
        }
    };
}

macro_rules! real {
    ($real:ident, $vector:ident, $lanes:ident, $splat:ident, $mul_add:ident, $sum:ident, $slice:ident,
     $slice_mut:ident, $load:ident, $store:ident) => {
        impl Real for $real {
            type Vector<S: Simd> = S::$vector;
            const ROUNDOFF: f64 = $real::EPSILON as f64 / 2.0;
            #[inline(always)]
            fn lanes<S: Simd>() -> usize {
                S::$lanes
            }
            #[inline(always)]
            fn absolute(self) -> Self {
                self.abs()
            }
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $real
            }
            #[inline(always)]
            fn splat<S: Simd>(simd: S, value: Self) -> S::$vector {
                simd.$splat(value)
            }
            #[inline(always)]
            fn mul_add<S: Simd>(simd: S, a: S::$vector, b: S::$vector, c: S::$vector) -> S::$vector {
                simd.$mul_add(a, b, c)
            }
            #[inline(always)]
            fn sum<S: Simd>(simd: S, a: S::$vector) -> Self {
                simd.$sum(a)
            }
            #[inline(always)]
            fn vectors<S: Simd>(values: &[Self]) -> (&[S::$vector], &[Self]) {
                S::$slice(values)
            }
            #[inline(always)]
            fn vectors_mut<S: Simd>(values: &mut [Self]) -> (&mut [S::$vector], &mut [Self]) {
                S::$slice_mut(values)
            }
            #[inline(always)]
            fn load_part<S: Simd>(simd: S, values: &[Self]) -> S::$vector {
                simd.$load(values)
            }
            #[inline(always)]
            fn store_part<S: Simd>(simd: S, values: &mut [Self], vector: S::$vector) {
                simd.$store(values, vector);
            }
        }

        impl Number for $real {
            compiled_here!();
            type Real = Self;
            type Single = f32;
            const PARTS: usize = 1;
            const PRODUCTS: usize = 1;
            #[inline(always)]
            fn from_real(real: Self) -> Self {
                real
            }
            #[inline(always)]
            fn from_parts(parts: [Self; 2]) -> Self {
                parts[0]
            }
            #[inline(always)]
            fn parts(self) -> [Self; 2] {
                [self, 0.0]
            }
            #[inline(always)]
            fn factors(self) -> [Self; 3] {
                [self, 0.0, 0.0]
            }
            #[inline(always)]
            fn from_products(products: [Self; 3]) -> Self {
                products[0]
            }
            #[inline(always)]
            fn size(self) -> f64 {
                f64::from(self.abs())
            }
            #[inline(always)]
            fn scale(self, by: Self) -> Self {
                self * by
            }
            #[inline(always)]
            fn to_single(self) -> f32 {
                self as f32
            }
            #[inline(always)]
            fn from_single(single: f32) -> Self {
                Self::from(single)
            }
            #[inline(always)]
            fn is_negative(self) -> bool {
                self < 0.0
            }
        }

        impl Scalar for $real {
            const ONE: Self = 1.0;
            #[inline(always)]
            fn modulus(self) -> f64 {
                f64::from(self.abs())
            }
            #[inline(always)]
            fn conjugate(self) -> Self {
                self
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                $real::is_finite(self)
            }
        }

        impl Number for Complex<$real> {
            compiled_here!();
            type Real = $real;
            type Single = c32;
            const PARTS: usize = 2;
            const PRODUCTS: usize = 3;
            #[inline(always)]
            fn from_real(real: $real) -> Self {
                Complex::new(real, 0.0)
            }
            #[inline(always)]
            fn from_parts(parts: [$real; 2]) -> Self {
                Complex::new(parts[0], parts[1])
            }
            #[inline(always)]
            fn parts(self) -> [$real; 2] {
                [self.re, self.im]
            }
            #[inline(always)]
            fn factors(self) -> [$real; 3] {
                [self.re, self.im, self.re + self.im]
            }
            #[inline(always)]
            fn from_products(products: [$real; 3]) -> Self {
                let [re, im, both] = products;
                Complex::new(re - im, both - re - im)
            }
            #[inline(always)]
            fn size(self) -> f64 {
                f64::from(self.re.abs()) + f64::from(self.im.abs())
            }
            #[inline(always)]
            fn scale(self, by: $real) -> Self {
                self * by
            }
            #[inline(always)]
            fn to_single(self) -> c32 {
                Complex::new(self.re as f32, self.im as f32)
            }
            #[inline(always)]
            fn from_single(single: c32) -> Self {
                Complex::new(single.re.into(), single.im.into())
            }
            #[inline(always)]
            fn is_negative(self) -> bool {
                false
            }
        }

        impl Scalar for Complex<$real> {
            const ONE: Self = Complex { re: 1.0, im: 0.0 };
            #[inline(always)]
            fn modulus(self) -> f64 {
                f64::from(self.re).hypot(f64::from(self.im))
            }
            #[inline(always)]
            fn conjugate(self) -> Self {
                self.conj()
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                self.re.is_finite() && self.im.is_finite()
            }
        }
    };
}

real!(
    f64,
    f64s,
    F64_LANES,
    splat_f64s,
    mul_add_f64s,
    reduce_sum_f64s,
    as_simd_f64s,
    as_mut_simd_f64s,
    partial_load_f64s,
    partial_store_f64s
);
real!(
    f32,
    f32s,
    F32_LANES,
    splat_f32s,
    mul_add_f32s,
    reduce_sum_f32s,
    as_simd_f32s,
    as_mut_simd_f32s,
    partial_load_f32s,
    partial_store_f32s
);

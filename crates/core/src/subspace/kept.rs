//! A reduced model that outlives its run.

use super::Subspace;
use super::basis::Basis;
use super::parts::Parts;
use super::projection::Projection;
use super::shift::{Shift, ShiftedSum};
use super::sketch::SKETCH_SIZE;
use super::trained_box::TrainedBox;
use crate::c64;
use crate::model::{DynamicStiffness, Experiment};
use crate::response::Work;
use std::borrow::Cow;
use std::fmt;

/// A [`Subspace`] without its model: trained once, it serves every run with the same matrices, load and sensors (B-3).
///
/// It is a set of arrays with names, and whoever wants it on disk writes those ([`KeptSubspace::arrays`], [`KeptSubspace::new`]). A clone shares what is
/// long. Factorisations are not among them: one is done again when a run needs more vectors.
///
/// # Limits
/// It knows the sizes of its model and no more: that the matrices, the load and the sensors are those that it was trained with is for the caller to see to.
#[derive(Debug, Clone)]
pub struct KeptSubspace {
    terms: usize,
    basis: Basis,
    shift: ShiftedSum,
    is_definite: bool,
    boxes: Vec<TrainedBox>,
}

/// An array of a reduced model: name, sizes (the last index runs fastest) and numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptArray<'k> {
    /// Its name.
    pub name: &'static str,
    /// How many there are along each index.
    pub shape: Vec<usize>,
    /// The numbers.
    pub values: Cow<'k, [f64]>,
}

/// Why a kept reduced model cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum KeptError {
    /// An array is missing.
    Missing(&'static str),
    /// An array has other sizes than belong to the others, or numbers that are not finite.
    Array(&'static str),
    /// The model is another one: what is counted, as it was kept, and as it is.
    Model {
        /// What is counted.
        what: &'static str,
        /// Of the kept model.
        kept: usize,
        /// Of the model that it is to be used with.
        model: usize,
    },
}

impl fmt::Display for KeptError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(name) => write!(f, "there is no array {name:?}"),
            Self::Array(name) => write!(f, "the array {name:?} does not fit the others"),
            Self::Model { what, kept, model } => {
                write!(f, "it was trained for a model with {kept} {what}, and this one has {model}")
            }
        }
    }
}

impl std::error::Error for KeptError {}

const WEIGHT: &str = "weight";
const VECTORS: &str = "vectors";
const MATRICES: &str = "matrices";
const IMAGES: &str = "images";
const LOAD: &str = "load";
const SENSORS: &str = "sensors";
const SKETCHED: &str = "sketched";
const GAIN: &str = "gain";
const SHIFT: &str = "shift";
const BOXES: &str = "boxes";

/// Numbers of a box for each term: [low, high] of the real and of the imaginary part.
const PER_TERM: usize = 4;

impl KeptSubspace {
    /// The names of its arrays.
    pub const ARRAYS: [&'static str; 10] =
        [WEIGHT, VECTORS, MATRICES, IMAGES, LOAD, SENSORS, SKETCHED, GAIN, SHIFT, BOXES];

    /// All that it is: diag(d) and V by vectors; VᵀS_gV, ΘS_gV, VᵀF, ℓ_mᵀV, ΘF and Θℓ_m; γ; of the factorisation whether the first one was positive definite, and the weight of each
    /// term; of each training its frequencies in Hz and the factor of each term, [low, high] of real and imaginary part. Complex numbers are pairs.
    pub fn arrays(&self) -> Vec<KeptArray<'_>> {
        let Projection { size, matrices, images, load, sensors, sketched, gain, .. } = &self.basis.projection;
        let (r, n) = (*size, self.basis.weight.len());
        let pairs = |values: &[c64]| -> Vec<f64> { values.iter().flat_map(|v| [v.re, v.im]).collect() };
        let array = |name, shape: &[usize], values| KeptArray { name, shape: shape.to_vec(), values };
        let mut shift = vec![f64::from(u8::from(self.is_definite))];
        shift.resize(1 + self.terms, 0.0);
        self.shift.weights.iter().for_each(|&(term, weight)| shift[1 + term] = weight);
        let trained = |trained: &TrainedBox| -> Vec<f64> {
            trained
                .frequency_hz
                .into_iter()
                .chain(trained.factors.iter().flatten().flatten().copied())
                .collect()
        };
        vec![
            array(WEIGHT, &[n], Cow::Borrowed(&self.basis.weight[..])),
            array(VECTORS, &[r, n], Cow::Borrowed(self.basis.vectors().columns(0..r))),
            array(MATRICES, &[matrices.len(), r, r], Cow::Owned(matrices.concat())),
            array(IMAGES, &[images.len(), r, SKETCH_SIZE], Cow::Owned(images.concat())),
            array(LOAD, &[r, 2], Cow::Owned(pairs(load))),
            array(SENSORS, &[sensors.len(), r], Cow::Owned(sensors.concat())),
            array(SKETCHED, &[sketched.len(), SKETCH_SIZE, 2], Cow::Owned(pairs(&sketched.concat()))),
            array(GAIN, &[1], Cow::Owned(vec![*gain])),
            array(SHIFT, &[1 + self.terms], Cow::Owned(shift)),
            array(
                BOXES,
                &[self.boxes.len(), 2 + PER_TERM * self.terms],
                Cow::Owned(self.boxes.iter().flat_map(trained).collect()),
            ),
        ]
    }

    /// From its arrays, for a model.
    ///
    /// # Errors
    /// [`KeptError`] for an array that is missing or does not fit the others, and for a model of another size.
    pub fn new(model: &DynamicStiffness, arrays: Vec<KeptArray<'_>>) -> Result<Self, KeptError> {
        let mut arrays = arrays;
        let mut take = |name: &'static str, rank: usize| {
            let found = arrays.iter().position(|array| array.name == name);
            let array = arrays.swap_remove(found.ok_or(KeptError::Missing(name))?);
            let count = array.shape.iter().try_fold(1usize, |count, &n| count.checked_mul(n));
            let fits = array.shape.len() == rank && count == Some(array.values.len());
            // A box without a mass' factor has no ends.
            let is_finite = name == BOXES || array.values.iter().all(|value| value.is_finite());
            if fits && is_finite {
                Ok((array.shape, array.values.into_owned()))
            } else {
                Err(KeptError::Array(name))
            }
        };
        let (shape, weight) = take(WEIGHT, 1)?;
        let n = shape[0];
        let (terms, parts) = (model.terms().len(), Parts::of(model));
        same("degrees of freedom", n, model.dim())?;
        let (shape, vectors) = take(VECTORS, 2)?;
        let r = shape[0];
        let sized = |name, shape: &[usize], expected: &[usize]| {
            if shape == expected { Ok(()) } else { Err(KeptError::Array(name)) }
        };
        sized(VECTORS, &shape, &[r, n])?;
        let (shape, matrices) = take(MATRICES, 3)?;
        same("real matrices", shape[0], parts.len())?;
        sized(MATRICES, &shape, &[parts.len(), r, r])?;
        let (shape, images) = take(IMAGES, 3)?;
        sized(IMAGES, &shape, &[parts.len(), r, SKETCH_SIZE])?;
        let (shape, load) = take(LOAD, 2)?;
        sized(LOAD, &shape, &[r, 2])?;
        let (shape, sensors) = take(SENSORS, 2)?;
        let count = shape[0];
        sized(SENSORS, &shape, &[count, r])?;
        let (shape, sketched) = take(SKETCHED, 3)?;
        sized(SKETCHED, &shape, &[1 + count, SKETCH_SIZE, 2])?;
        let (shape, gain) = take(GAIN, 1)?;
        sized(GAIN, &shape, &[1])?;
        let (shape, shift) = take(SHIFT, 1)?;
        same("matrices", shape[0].saturating_sub(1), terms)?;
        let (shape, boxes) = take(BOXES, 2)?;
        sized(BOXES, &shape, &[shape[0], 2 + PER_TERM * terms])?;
        if r == 0 {
            return Err(KeptError::Array(VECTORS));
        }
        let cut = |values: &[f64], length: usize| -> Vec<Vec<f64>> {
            values.chunks_exact(length).map(<[f64]>::to_vec).collect()
        };
        let numbers = |values: &[f64]| -> Vec<c64> {
            values.chunks_exact(2).map(|pair| c64::new(pair[0], pair[1])).collect()
        };
        let projection = Projection {
            parts,
            size: r,
            matrices: cut(&matrices, r * r),
            images: cut(&images, r * SKETCH_SIZE),
            load: numbers(&load),
            sensors: cut(&sensors, r),
            sketched: sketched.chunks_exact(2 * SKETCH_SIZE).map(numbers).collect(),
            gain: gain[0],
        };
        let weights = shift[1..].iter().copied().enumerate().filter(|(_, weight)| *weight != 0.0);
        let trained = |row: &[f64]| TrainedBox {
            frequency_hz: [row[0], row[1]],
            factors: row[2..].chunks_exact(PER_TERM).map(|v| [[v[0], v[1]], [v[2], v[3]]]).collect(),
        };
        Ok(Self {
            terms,
            basis: Basis::kept(weight, vectors, projection),
            shift: ShiftedSum { weights: weights.collect() },
            is_definite: shift[0] != 0.0,
            boxes: boxes.chunks_exact(2 + PER_TERM * terms).map(trained).collect(),
        })
    }

    /// Number of basis vectors r.
    pub fn size(&self) -> usize {
        self.basis.projection.size()
    }
}

fn same(what: &'static str, kept: usize, model: usize) -> Result<(), KeptError> {
    if kept == model { Ok(()) } else { Err(KeptError::Model { what, kept, model }) }
}

impl<'m> Subspace<'m> {
    /// What of it outlives its model.
    pub fn kept(&self) -> KeptSubspace {
        KeptSubspace {
            terms: self.model.terms().len(),
            basis: self.basis.clone(),
            shift: self.shift.sum.clone(),
            is_definite: self.is_definite,
            boxes: self.boxes.clone(),
        }
    }

    /// One that was kept, with the model, the load and the sensors that it was trained with.
    ///
    /// # Errors
    /// [`KeptError::Model`] where their numbers differ.
    pub fn of_kept(
        kept: &KeptSubspace,
        model: &'m DynamicStiffness,
        experiment: &'m Experiment,
    ) -> Result<Self, KeptError> {
        let small = &kept.basis.projection;
        same("degrees of freedom", kept.basis.weight.len(), model.dim())?;
        same("matrices", kept.terms, model.terms().len())?;
        same("real matrices", small.parts.len(), Parts::of(model).len())?;
        same("sensors", small.sensors.len(), experiment.sensors.len())?;
        let mut basis = kept.basis.clone();
        basis.projection.parts = Parts::of(model);
        Ok(Self {
            model,
            experiment,
            basis,
            shift: Shift::kept(kept.shift.clone()),
            is_definite: kept.is_definite,
            work: Work::default(),
            boxes: kept.boxes.clone(),
            more_solves: 0,
        })
    }
}

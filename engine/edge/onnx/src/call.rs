//! [`Call`]: an operator's inputs, settings and bounds.

use crate::attributes::Attribute;
use crate::tensor::{MOST_AXES, MOST_NUMBERS, Tensor, TensorValues, count, listed};
use std::cell::Cell;
use std::collections::BTreeMap;

/// Most multiplications and moves of numbers in a run.
const MOST_WORK: usize = 1 << 28;
/// Work of a function of a number, such as the exponential.
pub const FUNCTION: usize = 32;

/// Work of a run, which is bounded.
pub struct Work {
    left: Cell<usize>,
}

impl Work {
    /// Work of a run.
    pub fn new() -> Self {
        Self { left: Cell::new(MOST_WORK) }
    }

    fn spend(&self, work: Option<usize>) -> Result<(), String> {
        let left = work.and_then(|work| self.left.get().checked_sub(work));
        self.left
            .set(left.ok_or_else(|| format!("the network takes more than {MOST_WORK} operations for one action"))?);
        Ok(())
    }
}

/// An operator's inputs, settings and bounds.
pub struct Call<'a> {
    /// Inputs; none where one is left out.
    pub inputs: &'a [Option<&'a Tensor>],
    /// Settings.
    pub attributes: &'a BTreeMap<String, Attribute>,
    /// Count of outputs that are asked for.
    pub outputs: usize,
    /// Work of the run.
    pub work: &'a Work,
}

/// Numbers with their shape.
pub type Floats<'a> = (&'a [usize], &'a [f32]);

impl<'a> Call<'a> {
    /// An input that must be there.
    pub fn input(&self, at: usize) -> Result<&'a Tensor, String> {
        self.optional(at).ok_or_else(|| format!("its input {} is missing", at + 1))
    }

    /// An input that may be left out.
    pub fn optional(&self, at: usize) -> Option<&'a Tensor> {
        self.inputs.get(at).copied().flatten()
    }

    /// An input of floats.
    pub fn floats(&self, at: usize) -> Result<Floats<'a>, String> {
        let tensor = self.input(at)?;
        match &tensor.values {
            TensorValues::Floats(values) => Ok((&tensor.shape, values)),
            TensorValues::Wholes(_) => Err(format!("its input {} has whole numbers where floats are expected", at + 1)),
        }
    }

    /// An input of floats with a number of axes.
    pub fn of_axes(&self, at: usize, axes: usize) -> Result<Floats<'a>, String> {
        let (shape, values) = self.floats(at)?;
        match shape.len() == axes {
            true => Ok((shape, values)),
            false => Err(format!("its input {} has the shape {shape:?}; it must have {axes} axes", at + 1)),
        }
    }

    /// An input of floats whose shape must be this.
    pub fn of_shape(&self, at: usize, wanted: &[usize]) -> Result<&'a [f32], String> {
        let (shape, values) = self.floats(at)?;
        match shape == wanted {
            true => Ok(values),
            false => Err(format!("its input {} has the shape {shape:?}; it must be {wanted:?}", at + 1)),
        }
    }

    /// An input of whole numbers that may be left out.
    pub fn wholes(&self, at: usize) -> Result<Option<&'a [i64]>, String> {
        match self.optional(at).map(|tensor| &tensor.values) {
            None => Ok(None),
            Some(TensorValues::Wholes(values)) => {
                self.spend(&[values.len()])?;
                Ok(Some(values))
            }
            Some(TensorValues::Floats(_)) => {
                Err(format!("its input {} has floats where whole numbers are expected", at + 1))
            }
        }
    }

    /// A setting that is a whole number.
    pub fn whole(&self, name: &str, default: i64) -> Result<i64, String> {
        match self.attributes.get(name) {
            None => Ok(default),
            Some(Attribute::Whole(value)) => Ok(*value),
            Some(_) => Err(format!("its setting `{name}` must be a whole number")),
        }
    }

    /// A setting that is a number.
    pub fn float(&self, name: &str, default: f32) -> Result<f32, String> {
        match self.attributes.get(name) {
            None => Ok(default),
            Some(Attribute::Float(value)) => Ok(*value),
            Some(_) => Err(format!("its setting `{name}` must be a number")),
        }
    }

    /// A setting that is a list of whole numbers.
    pub fn list(&self, name: &str) -> Result<Option<&'a [i64]>, String> {
        match self.attributes.get(name) {
            None => Ok(None),
            Some(Attribute::Wholes(values)) => Ok(Some(values)),
            Some(_) => Err(format!("its setting `{name}` must be a list of whole numbers")),
        }
    }

    /// A setting that is a text.
    pub fn text(&self, name: &str, default: &'a str) -> Result<&'a str, String> {
        match self.attributes.get(name) {
            None => Ok(default),
            Some(Attribute::Text(value)) => Ok(value),
            Some(_) => Err(format!("its setting `{name}` must be a text")),
        }
    }

    /// An axis of a tensor, counted from the end where it is negative.
    pub fn axis(&self, axis: i64, axes: usize) -> Result<usize, String> {
        let counted = if axis < 0 { axis + axes as i64 } else { axis };
        let fits = usize::try_from(counted).ok().filter(|axis| *axis < axes);
        fits.ok_or_else(|| format!("it has the axis {axis} of a tensor with {axes} axes"))
    }

    /// Checks that a result of a shape may be made, and counts its numbers as work.
    pub fn room(&self, shape: &[usize]) -> Result<usize, String> {
        let count = count(shape).filter(|_| shape.len() <= MOST_AXES);
        let count = count.ok_or_else(|| {
            let shape = listed(shape);
            format!("its result has the shape {shape}; a tensor may have {MOST_NUMBERS} numbers and {MOST_AXES} axes")
        })?;
        // What is empty along one axis may be walked along another.
        self.work.spend(Some(shape.iter().map(|size| (*size).max(1)).product()))?;
        Ok(count)
    }

    /// [`Self::room`] for a result of functions such as the exponential.
    pub fn functions(&self, shape: &[usize]) -> Result<(), String> {
        let count = self.room(shape)?;
        self.spend(&[count, FUNCTION])
    }

    /// Counts work: the product of these numbers.
    pub fn spend(&self, factors: &[usize]) -> Result<(), String> {
        self.work.spend(factors.iter().try_fold(1_usize, |work, factor| work.checked_mul(*factor)))
    }

    /// Zeros of a shape.
    pub fn zeros(&self, shape: &[usize]) -> Result<Vec<f32>, String> {
        Ok(vec![0.0; self.room(shape)?])
    }

    /// Refuses a setting whose value is not read.
    pub fn only(&self, name: &str, allowed: i64) -> Result<(), String> {
        match self.whole(name, allowed)? {
            value if value == allowed => Ok(()),
            value => Err(format!("its setting `{name}` is {value}; {allowed} is read")),
        }
    }
}

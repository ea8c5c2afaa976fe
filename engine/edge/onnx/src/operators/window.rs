//! [`Window`]: where the windows of convolutions and pools lie on a picture.

use super::shapes::sizes;
use crate::call::Call;
use crate::tensor::listed;
use std::ops::Range;

/// Windows over a picture. A row of numbers is a picture of the height 1. Pairs are of rows and columns.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Size of the picture.
    pub picture: [usize; 2],
    /// Size of the window.
    pub size: [usize; 2],
    /// Distance from a window to the next.
    pub stride: [usize; 2],
    /// Distance between numbers that a window takes.
    pub dilation: [usize; 2],
    /// Rows and columns of nothing before the picture.
    pub before: [usize; 2],
    /// Count of windows.
    pub count: [usize; 2],
}

/// Largest size, stride, dilation and pad.
const LARGEST: usize = 1 << 12;

impl Window {
    /// The windows of a call on a tensor with the shape (number, channels, rows, columns), or without rows.
    pub fn of(call: &Call<'_>, shape: &[usize], kernel: Option<&[usize]>) -> Result<Self, String> {
        let axes = shape.len().wrapping_sub(2);
        if !matches!(axes, 1 | 2) {
            return Err(format!("its input has the shape {shape:?}; it must have 3 or 4 axes"));
        }
        let list = |name: &str, length: usize, least: usize, default: usize| -> Result<Vec<usize>, String> {
            let Some(list) = call.list(name)? else { return Ok(vec![default; length]) };
            let list = sizes(list)?;
            let fits = list.len() == length && list.iter().all(|it| (least..=LARGEST).contains(it));
            if fits {
                Ok(list)
            } else {
                Err(format!(
                    "its setting `{name}` is {}: {length} numbers, {least} to {LARGEST}, are read",
                    listed(&list)
                ))
            }
        };
        let pair = |list: &[usize], of_row: usize| match *list {
            [rows, columns] => [rows, columns],
            [columns] => [of_row, columns],
            _ => [of_row; 2],
        };
        let stated = list("kernel_shape", axes, 1, 0)?;
        let size = pair(kernel.unwrap_or(&stated), 1);
        if pair(&stated, 1) != size && call.list("kernel_shape")?.is_some() || size.contains(&0) {
            return Err(format!("its window has the size {size:?}, `kernel_shape` says {stated:?}"));
        }
        let (stride, dilation) = (pair(&list("strides", axes, 1, 1)?, 1), pair(&list("dilations", axes, 1, 1)?, 1));
        let (picture, pads) = (pair(&shape[2..], 1), list("pads", 2 * axes, 0, 0)?);
        let (mut before, mut after) = (pair(&pads[..axes], 0), pair(&pads[axes..], 0));
        let reach = [0, 1].map(|axis| dilation[axis] * (size[axis] - 1) + 1);
        match call.text("auto_pad", "NOTSET")? {
            "NOTSET" => {}
            "VALID" => (before, after) = ([0; 2], [0; 2]),
            place @ ("SAME_UPPER" | "SAME_LOWER") => {
                for axis in 0..2 {
                    let windows = picture[axis].div_ceil(stride[axis]).max(1);
                    let all = ((windows - 1) * stride[axis] + reach[axis]).saturating_sub(picture[axis]);
                    let (half, other) = (all / 2, all - all / 2);
                    (before[axis], after[axis]) = if place == "SAME_UPPER" { (half, other) } else { (other, half) };
                }
            }
            other => {
                return Err(format!(
                    "its setting `auto_pad` is `{other}`; NOTSET, VALID, SAME_UPPER, SAME_LOWER are read"
                ));
            }
        }
        let count = [0, 1].map(|axis| {
            let free = (picture[axis] + before[axis] + after[axis]).checked_sub(reach[axis]);
            free.map_or(0, |free| free / stride[axis] + 1)
        });
        if count.contains(&0) || picture.contains(&0) {
            return Err(format!("its window of the size {size:?} does not fit the picture {picture:?}"));
        }
        Ok(Self { picture, size, stride, dilation, before, count })
    }

    /// Place in the picture that a window takes along an axis; none beside it.
    pub fn place(&self, axis: usize, window: usize, at: usize) -> Option<usize> {
        let place = (window * self.stride[axis] + at * self.dilation[axis]).checked_sub(self.before[axis])?;
        (place < self.picture[axis]).then_some(place)
    }

    /// The windows along an axis whose number `at` lies in the picture, and its place for the first of them.
    pub fn span(&self, axis: usize, at: usize) -> Option<(Range<usize>, usize)> {
        let (shift, before, stride) = (at * self.dilation[axis], self.before[axis], self.stride[axis]);
        let first = before.saturating_sub(shift).div_ceil(stride);
        let last = (self.picture[axis] - 1 + before).checked_sub(shift)? / stride;
        let end = self.count[axis].min(last + 1);
        (first < end).then(|| (first..end, first * stride + shift - before))
    }

    /// Shape of a result with a number of channels, for an input of a shape.
    pub fn shape(&self, input: &[usize], channels: usize) -> Vec<usize> {
        let from = if input.len() == 3 { 1 } else { 0 };
        [&[input[0], channels], &self.count[from..]].concat()
    }
}

#[cfg(test)]
mod tests {
    use crate::attributes::Attribute;
    use crate::call::{Call, Work};
    use crate::operators::convolution::conv;
    use crate::tensor::Tensor;
    use std::collections::BTreeMap;

    #[test]
    fn no_window_fits_an_empty_picture() {
        let (picture, weights) = (Tensor::floats(&[1, 1, 1, 0], vec![]), Tensor::floats(&[1, 1, 1, 1], vec![1.0]));
        let attributes = BTreeMap::from([("pads".to_owned(), Attribute::Wholes(vec![0, 1, 0, 1]))]);
        let (inputs, work) = ([Some(&picture), Some(&weights)], Work::new());
        let call = Call { inputs: &inputs, attributes: &attributes, outputs: 1, work: &work };
        let refused = conv(&call).expect_err("an empty picture");
        assert!(refused.contains("does not fit the picture"), "{refused}");
    }
}

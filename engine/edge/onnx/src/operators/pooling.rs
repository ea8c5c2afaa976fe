//! Pools: the largest number, or the mean, of each window.

use super::elementwise::larger;
use super::window::Window;
use crate::call::Call;
use crate::tensor::Tensor;

type Outcome = Result<Vec<Tensor>, String>;

/// The numbers of each window, put together by `of`, which gets those within the picture and the size of the window.
fn pooled(call: &Call<'_>, of: impl Fn(&[f32], usize) -> f32) -> Outcome {
    let (shape, picture) = call.floats(0)?;
    call.only("ceil_mode", 0)?;
    let window = Window::of(call, shape, None)?;
    let shape_out = window.shape(shape, shape[1]);
    let mut values = call.zeros(&shape_out)?;
    let [pixels, taps, windows] = [window.picture, window.size, window.count].map(|[rows, columns]| rows * columns);
    call.spend(&[values.len(), taps])?;
    let mut taken = Vec::with_capacity(taps);
    for (at, to) in values.iter_mut().enumerate() {
        let (channel, row, column) = (at / windows, at % windows / window.count[1], at % window.count[1]);
        let from = &picture[channel * pixels..][..pixels];
        taken.clear();
        for row_at in 0..window.size[0] {
            let Some(place) = window.place(0, row, row_at) else { continue };
            let columns = (0..window.size[1]).filter_map(|column_at| window.place(1, column, column_at));
            taken.extend(columns.map(|column| from[place * window.picture[1] + column]));
        }
        *to = of(&taken, taps);
    }
    Ok(vec![Tensor::floats(&shape_out, values)])
}

/// `MaxPool`.
pub fn max(call: &Call<'_>) -> Outcome {
    call.only("storage_order", 0)?;
    pooled(call, |taken, _| taken.iter().copied().fold(f32::NEG_INFINITY, larger))
}

/// `AveragePool`.
pub fn average(call: &Call<'_>) -> Outcome {
    let counts_all = call.whole("count_include_pad", 0)? != 0;
    let count = |taken: &[f32], all: usize| if counts_all { all } else { taken.len().max(1) };
    pooled(call, |taken, all| taken.iter().sum::<f32>() / count(taken, all) as f32)
}

/// `GlobalAveragePool`.
pub fn global_average(call: &Call<'_>) -> Outcome {
    let (shape, values) = call.floats(0)?;
    if shape.len() < 3 {
        return Err(format!("its input has the shape {shape:?}; it must have 3 axes or more"));
    }
    let pixels: usize = shape[2..].iter().product();
    call.spend(&[values.len()])?;
    let shape_out: Vec<usize> = shape.iter().enumerate().map(|(axis, size)| if axis < 2 { *size } else { 1 }).collect();
    let means = values.chunks_exact(pixels.max(1)).map(|channel| channel.iter().sum::<f32>() / pixels as f32);
    let means: Vec<f32> = means.collect();
    match means.len() == call.room(&shape_out)? {
        true => Ok(vec![Tensor::floats(&shape_out, means)]),
        false => Err(format!("its input has the shape {shape:?}, without a number")),
    }
}

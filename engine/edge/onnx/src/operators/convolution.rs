//! Convolutions of pictures and rows. Each sum begins with the bias and runs over channels, rows and columns of the window.

use super::window::Window;
use crate::call::Call;
use crate::tensor::Tensor;

/// `Conv`.
pub fn conv(call: &Call<'_>) -> Result<Vec<Tensor>, String> {
    let ((shape, picture), (of_weights, weights)) = (call.floats(0)?, call.floats(1)?);
    let groups = usize::try_from(call.whole("group", 1)?).unwrap_or(0);
    let fits = shape.len() == of_weights.len()
        && (3..=4).contains(&shape.len())
        && groups > 0
        && of_weights[0] % groups == 0
        && of_weights[1].checked_mul(groups) == Some(shape[1]);
    if !fits {
        return Err(format!("the weights {of_weights:?} in {groups} groups do not fit the input {shape:?}"));
    }
    let window = Window::of(call, shape, Some(&of_weights[2..]))?;
    let [filters, channels] = [of_weights[0], of_weights[1]];
    let bias = call.optional(2).map(|_| call.of_shape(2, &[filters])).transpose()?;
    let (shape_out, pixels_out) = (window.shape(shape, filters), window.count[0] * window.count[1]);
    let mut values = call.zeros(&shape_out)?;
    let [pixels, taps] = [window.picture, window.size].map(|[rows, columns]| rows * columns);
    call.spend(&[values.len(), channels, taps])?;
    for (at, to) in values.chunks_exact_mut(pixels_out.max(1)).enumerate() {
        let (number, filter) = (at / filters, at % filters);
        to.fill(bias.map_or(0.0, |bias| bias[filter]));
        let first = number * shape[1] + filter / (filters / groups) * channels;
        for channel in 0..channels {
            let from = &picture[(first + channel) * pixels..][..pixels];
            let weights = &weights[(filter * channels + channel) * taps..][..taps];
            add_window(to, from, weights, &window);
        }
    }
    Ok(vec![Tensor::floats(&shape_out, values)])
}

/// Adds the windows of one channel, each weighed by one kernel.
fn add_window(to: &mut [f32], from: &[f32], weights: &[f32], window: &Window) {
    let Window { picture: [_, width], size: [_, columns], count: [_, across], .. } = *window;
    for (tap, weight) in weights.iter().enumerate() {
        let (row_at, column_at) = (tap / columns, tap % columns);
        for (row, to) in to.chunks_exact_mut(across).enumerate() {
            let Some(place) = window.place(0, row, row_at) else { continue };
            let from = &from[place * width..][..width];
            let Some((windows, first)) = window.span(1, column_at) else { continue };
            let taken = from[first..].iter().step_by(window.stride[1]);
            to[windows].iter_mut().zip(taken).for_each(|(to, from)| *to += weight * from);
        }
    }
}

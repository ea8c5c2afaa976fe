//! Images of a log as pixels, whole or scaled.

use crate::errors::{raised, refused};
use cosfly_channel_pictures::false_colours::{palette_image, picture_on_request};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::channels::Element;
use cosfly_domain::{Channel, channels};
use cosfly_images::read::{self, Picture};
use cosfly_read::StoredImage;
use numpy::{PyArray1, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

/// Pixels of an image.
pub enum Pixels {
    /// Colours or other bytes: three per pixel.
    Bytes(Vec<u8>),
    /// Labels, or 0 and 1: one byte per pixel.
    Labels(Vec<u8>),
    /// Depth, metres, or disparity, pixels.
    Depth(Vec<f32>),
    /// Ids.
    Ids(Vec<u32>),
    /// Two numbers per pixel.
    Pairs(Vec<f32>),
}

/// Pixels with their size.
pub struct Image {
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Pixels, row-major.
    pub pixels: Pixels,
}

impl Image {
    /// Unpacks a stored image; colours are averaged over the source's area when scaled, other channels are sampled at
    /// the middle of each pixel. Lengths in pixels, such as flow, are those of the scaled picture.
    ///
    /// # Errors
    /// An image file that cannot be decoded.
    pub fn unpack(channel: &Channel, stored: StoredImage, size: Option<[usize; 2]>) -> Result<Self> {
        match stored {
            StoredImage::File(file, format) => {
                let Picture { size, rgb } = read::picture(&file, &format, size)?;
                Ok(Self { size, pixels: Pixels::Bytes(rgb) })
            }
            StoredImage::Raw { data, width, height, pixel_bytes } => {
                let from = [width as usize, height as usize];
                let size = size.unwrap_or(from);
                let pixels = match (channel.element(), pixel_bytes) {
                    (Element::Label | Element::Flag, 1) => {
                        Pixels::Labels(read::sampled(data.as_chunks::<1>().0, from, size).into_flattened())
                    }
                    (Element::Float, 4) => Pixels::Depth(numbers(&data, from, size, f32::from_le_bytes)),
                    (Element::Id, 2) => {
                        Pixels::Ids(numbers(&data, from, size, |two| u32::from(u16::from_le_bytes(two))))
                    }
                    (Element::Id, 4) => Pixels::Ids(numbers(&data, from, size, u32::from_le_bytes)),
                    (Element::Pair, 8) => {
                        let pairs = read::sampled(data.as_chunks::<8>().0, from, size).into_flattened();
                        Pixels::Pairs(numbers(
                            &pairs,
                            [2 * size[0], size[1]],
                            [2 * size[0], size[1]],
                            f32::from_le_bytes,
                        ))
                    }
                    (_, 3) => Pixels::Bytes(read::sampled(data.as_chunks::<3>().0, from, size).into_flattened()),
                    _ => {
                        return Err(Diagnostic::new(
                            "dataset-damaged",
                            Fault::Input,
                            "an image has pixels of an unknown kind",
                        ));
                    }
                };
                let across_and_down = [size[0] as f32 / from[0] as f32, size[1] as f32 / from[1] as f32];
                match pixels {
                    Pixels::Depth(mut values) if channel.is_in_pixels() && size != from => {
                        values.iter_mut().for_each(|value| *value *= across_and_down[0]);
                        Ok(Self { size, pixels: Pixels::Depth(values) })
                    }
                    Pixels::Pairs(mut values) if channel.is_in_pixels() && size != from => {
                        let scales = across_and_down.iter().cycle();
                        values.iter_mut().zip(scales).for_each(|(value, scale)| *value *= scale);
                        Ok(Self { size, pixels: Pixels::Pairs(values) })
                    }
                    pixels => Ok(Self { size, pixels }),
                }
            }
        }
    }

    /// The pixels as a numpy array of height x width (x 2 or 3).
    pub fn into_array(self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let [width, height] = self.size;
        Ok(match self.pixels {
            Pixels::Bytes(values) => PyArray1::from_vec(py, values).reshape([height, width, 3])?.into_any().unbind(),
            Pixels::Labels(values) => PyArray1::from_vec(py, values).reshape([height, width])?.into_any().unbind(),
            Pixels::Depth(values) => PyArray1::from_vec(py, values).reshape([height, width])?.into_any().unbind(),
            Pixels::Pairs(values) => PyArray1::from_vec(py, values).reshape([height, width, 2])?.into_any().unbind(),
            Pixels::Ids(values) => PyArray1::from_vec(py, values).reshape([height, width])?.into_any().unbind(),
        })
    }
}

fn numbers<const N: usize, T>(
    data: &[u8],
    from: [usize; 2],
    size: [usize; 2],
    number: impl Fn([u8; N]) -> T,
) -> Vec<T> {
    let pixels = data.as_chunks::<N>().0;
    if from == size {
        return pixels.iter().map(|bytes| number(*bytes)).collect();
    }
    read::sampled(pixels, from, size).into_iter().map(number).collect()
}

/// Decodes a JPEG or PNG file; with `size` (width, height) scaled by averaging over each pixel's area.
#[pyfunction]
#[pyo3(signature = (file, size = None))]
pub fn decode_rgb<'py>(
    py: Python<'py>,
    file: &[u8],
    size: Option<(usize, usize)>,
) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let format = if file.starts_with(b"\x89PNG") { "png" } else { "jpeg" };
    let size = checked(py, size)?;
    let picture = py.detach(|| read::picture(file, format, size));
    let Picture { size: [width, height], rgb } = raised(py, picture)?;
    PyArray1::from_vec(py, rgb).reshape([height, width, 3])
}

/// A PNG file that shows an image: colours as they are, depth from warm (near) to cold (far), labels in CARLA's colours, ids
/// in a colour each, flow in the colours of a wheel. `pixels` are the bytes of the array.
#[pyfunction]
pub fn shown(py: Python<'_>, channel: &str, pixels: &[u8], width: u32, height: u32) -> PyResult<Vec<u8>> {
    let (count, channel) = (width as usize * height as usize, raised(py, self::channel(channel))?);
    let rgb = match (channel.element(), pixels.len().checked_div(count)) {
        (_, Some(3)) => pixels.to_vec(),
        (Element::Float, Some(4)) | (Element::Flag, Some(1)) | (Element::Pair, Some(8)) => {
            picture_on_request(channel, pixels)
        }
        (Element::Label, Some(1)) => palette_image(pixels),
        (Element::Id, Some(4)) => {
            let ids = pixels.as_chunks::<4>().0.iter().map(|id| u32::from_le_bytes(*id));
            // Far apart for ids side by side; 0 is black.
            ids.flat_map(|id| [id.wrapping_mul(97), id.wrapping_mul(57), id.wrapping_mul(151)].map(|it| it as u8))
                .collect()
        }
        _ => {
            let message = format!("{} bytes are no image of {width} x {height}", pixels.len());
            return Err(refused(py, "InvalidValue", &message));
        }
    };
    let mut file = vec![];
    raised(py, cosfly_images::rgb::png(&rgb, width, height, &mut file))?;
    Ok(file)
}

/// A size of pictures, width and height.
///
/// # Errors
/// A side that is 0 or above 16,384.
pub fn checked(py: Python<'_>, size: Option<(usize, usize)>) -> PyResult<Option<[usize; 2]>> {
    match size {
        Some((width, height)) if [width, height].iter().any(|side| !(1..=16_384).contains(side)) => {
            let message = format!("the size is {width} x {height}; sides are from 1 to 16384 pixels");
            Err(refused(py, "InvalidValue", &message))
        }
        size => Ok(size.map(|(width, height)| [width, height])),
    }
}

/// The channel called `name`.
///
/// # Errors
/// `dataset-channel`.
pub fn channel(name: &str) -> Result<&'static Channel> {
    channels::called(name).ok_or_else(|| {
        let all: Vec<_> = channels::ALL.iter().map(|channel| channel.name).collect();
        Diagnostic::new("dataset-channel", Fault::Recipe, format!("there is no channel `{name}`"))
            .hint(format!("the channels are {}", all.join(", ")))
    })
}

//! The figures of a row of table `trajectories`, as the checks need them.

use cosfly_diagnose::Result;
use cosfly_read::Rows;
use cosfly_schema::Role;
use cosfly_schema::tables::{Column, DatasetItem, Trajectories};

/// The figures of a row of table `trajectories`: sums over its frames, limits, certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// Expert or perturbed.
    pub role: Role,
    /// Focal length and optical centre.
    pub focal_and_centre_px: [f64; 3],
    /// Whether depth is said to be along the rays of pixels.
    pub depth_is_along_rays: bool,
    /// Number of frames with the target in the image.
    pub frames_in_view: u32,
    /// Values of [`MEANS`].
    pub means: [f64; 5],
    /// Smallest distance of the swept path to an obstacle, metres.
    pub min_clearance_m: f64,
    /// Values of [`MAXIMA`].
    pub maxima: [f64; 5],
    /// Whether the certificate holds.
    pub holds: bool,
}

/// Columns that must follow from the frames.
pub const MEANS: [Column<DatasetItem, f64>; 5] = [
    Trajectories::mean_visible_by_pixels,
    Trajectories::mean_visibility,
    Trajectories::frames_half_visible,
    Trajectories::mean_distance_m,
    Trajectories::length_m,
];
/// Largest speed, acceleration, jerk, yaw rate, pitch rate.
pub const MAXIMA: [Column<DatasetItem, f64>; 5] = [
    Trajectories::max_speed_mps,
    Trajectories::max_acceleration_mps2,
    Trajectories::max_jerk_mps3,
    Trajectories::max_yaw_rate_deg_s,
    Trajectories::max_pitch_rate_deg_s,
];
const CAMERA: [Column<DatasetItem, f64>; 3] =
    [Trajectories::camera_focal_px, Trajectories::camera_cx_px, Trajectories::camera_cy_px];

impl Figures {
    /// The figures in a row of `trajectories`.
    ///
    /// # Errors
    /// A column that holds no value.
    pub fn read(rows: &Rows<'_>, row: usize) -> Result<Self> {
        Ok(Self {
            role: rows.get(Trajectories::role, row)?,
            focal_and_centre_px: numbers(rows, row, &CAMERA)?,
            depth_is_along_rays: rows.get(Trajectories::camera_depth_is_along_rays, row)?,
            frames_in_view: rows.get(Trajectories::frames_in_view, row)?,
            means: numbers(rows, row, &MEANS)?,
            min_clearance_m: rows.get(Trajectories::min_clearance_m, row)?,
            maxima: maxima(rows, row)?,
            holds: rows.get(Trajectories::certificate_holds, row)?,
        })
    }
}

/// Values of [`MAXIMA`]; NaN for those of rates of turning in datasets from before these columns.
fn maxima(rows: &Rows<'_>, row: usize) -> Result<[f64; 5]> {
    let mut maxima = [0.0; 5];
    for (number, column) in maxima.iter_mut().zip(MAXIMA) {
        *number =
            if column.name.ends_with("_deg_s") { rows.get_or(column, row, f64::NAN)? } else { rows.get(column, row)? };
    }
    Ok(maxima)
}

fn numbers<const N: usize>(rows: &Rows<'_>, row: usize, columns: &[Column<DatasetItem, f64>; N]) -> Result<[f64; N]> {
    let mut numbers = [0.0; N];
    for (number, column) in numbers.iter_mut().zip(columns) {
        *number = rows.get(*column, row)?;
    }
    Ok(numbers)
}

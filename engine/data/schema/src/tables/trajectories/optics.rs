//! Shutter, lens, sensor and image processor of a trajectory's camera. Cards of exports list them.

use super::columns::Trajectories;
use crate::tables::DatasetItem;
use crate::tables::column::columns;

columns! { Trajectories::OPTICS of DatasetItem;
    /// Exposure time, centred on `time_s`, over which colour is blurred; depth and ids are of `time_s`; 0: no blur.
    camera_shutter_s: f64 = |item, _| item.record.motion_blur.shutter_s;
    /// Time from the top row to the bottom row, the middle row at `time_s`, in all channels; 0: all rows at once.
    camera_readout_s: f64 = |item, _| item.record.rolling_shutter.readout_s;
    /// Standard deviation of the blur of lens and sensor.
    camera_point_spread_px: f64 = |item, _| item.record.optics.point_spread_px;
    /// Strength of the image processor's sharpening; 0: none.
    camera_sharpening: f64 = |item, _| item.record.optics.sharpening;
    /// Steepness of the image processor's tone curve; 0: none.
    camera_contrast: f64 = |item, _| item.record.optics.contrast;
    /// Exposure beyond the one that suits the weather, in stops.
    camera_exposure_ev: f64 = |item, _| item.record.optics.exposure_ev;
    /// Colour temperature that is rendered as white, kelvin.
    camera_white_balance_k: f64 = |item, _| item.record.optics.white_balance_k;
    /// Strength of the glow around bright lamps at night; 0: none.
    camera_bloom: f64 = |item, _| item.record.optics.bloom;
    /// Standard deviation of the signal-independent noise of colour, in steps of 8 bits.
    camera_noise_gaussian: f64 = |item, _| item.record.noise.gaussian;
    /// Standard deviation of the noise of colour at white, proportional to the square root of brightness, in steps of 8
    /// bits; variances of both noises add up.
    camera_noise_shot: f64 = |item, _| item.record.noise.shot;
}

//! [`Splat`]: one ellipsoid of a cloud, as files and converters state it.

/// Most coefficients of a colour: spherical harmonics to degree 3.
pub const MOST_COEFFICIENTS: usize = 16;

/// A Gaussian with an opacity and a colour that depends on the direction of view, in the frame of its file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splat {
    /// Middle.
    pub middle: [f32; 3],
    /// Standard deviations along its own axes.
    pub spread: [f32; 3],
    /// Unit quaternion w, x, y, z from its own axes to the file's.
    pub turn: [f32; 4],
    /// Opacity of the middle, 0 to 1.
    pub opacity: f32,
    /// Red, green and blue of each spherical harmonic; those beyond the cloud's degree are not read.
    pub harmonics: [[f32; 3]; MOST_COEFFICIENTS],
}

impl Splat {
    /// A splat of one sRGB colour (0 to 1) from all sides.
    pub fn plain(middle: [f32; 3], spread: [f32; 3], turn: [f32; 4], opacity: f32, srgb: [f32; 3]) -> Self {
        let mut harmonics = [[0.0; 3]; MOST_COEFFICIENTS];
        harmonics[0] = srgb.map(|value| (value - 0.5) / crate::harmonics::CONSTANT);
        Self { middle, spread, turn, opacity, harmonics }
    }

    /// Covariance in the frame of the file: xx, xy, xz, yy, yz, zz.
    pub(crate) fn covariance(&self) -> [f64; 6] {
        let turn = self.turn.map(f64::from);
        let length = turn.iter().map(|part| part * part).sum::<f64>().sqrt();
        let [w, x, y, z] = turn.map(|part| part / length);
        let rows = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        let variance = self.spread.map(|spread| f64::from(spread) * f64::from(spread));
        let entry = |i: usize, j: usize| (0..3).map(|k| rows[i][k] * variance[k] * rows[j][k]).sum::<f64>();
        [entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)]
    }
}

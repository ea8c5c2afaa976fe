//! Real spherical harmonics to degree 3, with the signs of the reference trainer.

/// The harmonic of degree 0.
pub const CONSTANT: f32 = 0.282_094_8;

/// Values of the harmonics in a direction of unit length, in any kind of number.
macro_rules! harmonics {
    ($(#[$doc:meta])* $name:ident, $real:ty) => {
        $(#[$doc])*
        #[inline(always)]
        pub fn $name([x, y, z]: [$real; 3]) -> [$real; 16] {
            let (xx, yy, zz) = (x * x, y * y, z * z);
            let (xy, yz, xz) = (x * y, y * z, x * z);
            [
                0.282_094_791_773_878_14,
                -0.488_602_511_902_919_9 * y,
                0.488_602_511_902_919_9 * z,
                -0.488_602_511_902_919_9 * x,
                1.092_548_430_592_079_2 * xy,
                -1.092_548_430_592_079_2 * yz,
                0.315_391_565_252_520_05 * (2.0 * zz - xx - yy),
                -1.092_548_430_592_079_2 * xz,
                0.546_274_215_296_039_6 * (xx - yy),
                -0.590_043_589_926_643_5 * y * (3.0 * xx - yy),
                2.890_611_442_640_554 * xy * z,
                -0.457_045_799_464_465_8 * y * (4.0 * zz - xx - yy),
                0.373_176_332_590_115_4 * z * (2.0 * zz - 3.0 * xx - 3.0 * yy),
                -0.457_045_799_464_465_8 * x * (4.0 * zz - xx - yy),
                1.445_305_721_320_277 * z * (xx - yy),
                -0.590_043_589_926_643_5 * x * (xx - 3.0 * yy),
            ]
        }
    };
}

harmonics! {
    /// In single precision.
    #[expect(clippy::excessive_precision, reason = "one list of constants for both precisions")]
    single, f32
}
harmonics! {
    /// In double precision.
    double, f64
}

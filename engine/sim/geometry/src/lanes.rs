//! Sixteen numbers at a time: the operations that differ between vector levels, and the choice of the level.
//!
//! Kernels over these lanes never determine an answer: they decide clear hits and misses, with a margin for every
//! rounding, and exact arithmetic decides all others. So levels may round differently here (AVX-512 fuses products and
//! sums) and still give the same answers.

use cosfly_frames::simd::Level;

/// Number of lanes of a block.
pub const LANES: usize = 16;

/// One number per lane.
pub type Lane = [f32; LANES];

/// Operations that differ between vector levels.
pub trait Lanes: Copy {
    /// The vector level.
    fn level(self) -> Level;
    /// `a * b + c`, fused where that is one instruction.
    fn multiply_add(self, a: f32, b: f32, c: f32) -> f32;
    /// Mask whose bit i is set where `a[i] <= b[i]`.
    fn at_most(self, a: &Lane, b: &Lane) -> u32;
    /// Mask whose bit i is set where `a[i] <= b[i]`.
    fn at_most_f64(self, a: &[f64; 8], b: &[f64; 8]) -> u32;
}

/// A level built from its comparisons. Closures inherit the vector features of the function that creates them, which
/// makes their intrinsics safe to call.
#[derive(Clone, Copy)]
pub struct LevelLanes<F32, F64, const FUSED: bool> {
    /// See [`Lanes::at_most`].
    pub at_most: F32,
    /// See [`Lanes::at_most_f64`].
    pub at_most_f64: F64,
    /// See [`Lanes::level`].
    pub level: Level,
}

impl<F32, F64, const FUSED: bool> Lanes for LevelLanes<F32, F64, FUSED>
where
    F32: Fn(&Lane, &Lane) -> u32 + Copy,
    F64: Fn(&[f64; 8], &[f64; 8]) -> u32 + Copy,
{
    #[inline(always)]
    fn level(self) -> Level {
        self.level
    }
    #[inline(always)]
    fn multiply_add(self, a: f32, b: f32, c: f32) -> f32 {
        if FUSED { a.mul_add(b, c) } else { a * b + c }
    }
    #[inline(always)]
    fn at_most(self, a: &Lane, b: &Lane) -> u32 {
        (self.at_most)(a, b)
    }
    #[inline(always)]
    fn at_most_f64(self, a: &[f64; 8], b: &[f64; 8]) -> u32 {
        (self.at_most_f64)(a, b)
    }
}

/// The level available on every processor.
#[derive(Clone, Copy)]
pub struct PlainLanes;

impl Lanes for PlainLanes {
    #[inline(always)]
    fn level(self) -> Level {
        Level::PLAIN
    }
    #[inline(always)]
    fn multiply_add(self, a: f32, b: f32, c: f32) -> f32 {
        a * b + c
    }
    #[inline(always)]
    fn at_most(self, a: &Lane, b: &Lane) -> u32 {
        (0..LANES).fold(0, |mask, i| mask | u32::from(a[i] <= b[i]) << i)
    }
    #[inline(always)]
    fn at_most_f64(self, a: &[f64; 8], b: &[f64; 8]) -> u32 {
        (0..8).fold(0, |mask, i| mask | u32::from(a[i] <= b[i]) << i)
    }
}

/// The larger number in a single instruction; `b` when either is NaN.
#[inline(always)]
pub fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The smaller number in a single instruction; `b` when either is NaN.
#[inline(always)]
pub fn smaller<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// Removes the lowest set bit of a mask that is not 0, and returns its index.
#[inline(always)]
pub fn take_lane(mask: &mut u32) -> usize {
    let lane = mask.trailing_zeros() as usize % LANES;
    *mask &= mask.wrapping_sub(1);
    lane
}

/// `fn name(a: A) -> R = kernel;` defines `name(level, a)`, which runs the generic `kernel(lanes, a)`, an
/// `#[inline(always)]` function, compiled for the level.
macro_rules! at_level {
    ($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $ty:ty),* $(,)?) -> $ret:ty = $kernel:path;) => {
        $(#[$meta])*
        #[inline]
        $vis fn $name(level: cosfly_frames::simd::Level, $($arg: $ty),*) -> $ret {
            #[inline(never)]
            fn plain($($arg: $ty),*) -> $ret {
                $kernel($crate::lanes::PlainLanes, $($arg),*)
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2")]
            #[inline(never)]
            fn avx2(level: cosfly_frames::simd::Level, $($arg: $ty),*) -> $ret {
                use core::arch::x86_64::*;
                let half = |a: &$crate::lanes::Lane, i: usize| {
                    _mm256_setr_ps(a[i], a[i + 1], a[i + 2], a[i + 3], a[i + 4], a[i + 5], a[i + 6], a[i + 7])
                };
                let half_f64 = |a: &[f64; 8], i: usize| _mm256_setr_pd(a[i], a[i + 1], a[i + 2], a[i + 3]);
                let lanes = $crate::lanes::LevelLanes::<_, _, false> {
                    level,
                    at_most: |a: &$crate::lanes::Lane, b: &$crate::lanes::Lane| {
                        let bits = |i| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(half(a, i), half(b, i))) as u32;
                        bits(0) | bits(8) << 8
                    },
                    at_most_f64: |a: &[f64; 8], b: &[f64; 8]| {
                        let bits =
                            |i| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(half_f64(a, i), half_f64(b, i))) as u32;
                        bits(0) | bits(4) << 4
                    },
                };
                $kernel(lanes, $($arg),*)
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
            #[inline(never)]
            fn avx512(level: cosfly_frames::simd::Level, $($arg: $ty),*) -> $ret {
                use core::arch::x86_64::*;
                let all = |a: &$crate::lanes::Lane| {
                    let [a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, a13, a14, a15] = *a;
                    _mm512_setr_ps(a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, a13, a14, a15)
                };
                let all_f64 = |a: &[f64; 8]| _mm512_setr_pd(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7]);
                let lanes = $crate::lanes::LevelLanes::<_, _, true> {
                    level,
                    at_most: |a: &$crate::lanes::Lane, b: &$crate::lanes::Lane| {
                        u32::from(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(all(a), all(b)))
                    },
                    at_most_f64: |a: &[f64; 8], b: &[f64; 8]| {
                        u32::from(_mm512_cmp_pd_mask::<_CMP_LE_OQ>(all_f64(a), all_f64(b)))
                    },
                };
                $kernel(lanes, $($arg),*)
            }
            match level.kind() {
                // SAFETY: a level above the baseline exists only after its features were detected.
                #[cfg(target_arch = "x86_64")]
                cosfly_frames::simd::Kind::Avx512 => unsafe { avx512(level, $($arg),*) },
                // SAFETY: as above.
                #[cfg(target_arch = "x86_64")]
                cosfly_frames::simd::Kind::Avx2 => unsafe { avx2(level, $($arg),*) },
                _ => plain($($arg),*),
            }
        }
    };
}
pub(crate) use at_level;

//! Run-time choice of vector instructions for kernels written once in plain Rust.
//!
//! A kernel is an ordinary loop over arrays that compilers vectorise. [`simd_kernel!`](crate::simd_kernel) compiles it
//! for baseline x86-64 (or any other processor), for AVX2 and for AVX-512 (both with the bit-manipulation instructions
//! of their processors), and calls the version that a [`Level`] names. Rust neither fuses nor reorders floating-point
//! operations, so all levels give the same bytes.

/// Vector instructions of the processor. A level exists only after its detection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level(Kind);

static BEST: std::sync::OnceLock<Level> = std::sync::OnceLock::new();

/// Levels by name; a [`Level`] is made from one only after detection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[doc(hidden)]
pub enum Kind {
    Plain,
    Avx2,
    Avx512,
}

impl Level {
    /// Baseline of the architecture, available on every processor.
    pub const PLAIN: Self = Self(Kind::Plain);

    /// Level that kernels run at: the best of this processor, detected once, or the one set earlier by
    /// [`Self::make_best`].
    pub fn best() -> Self {
        *BEST.get_or_init(|| Self::available().last().copied().unwrap_or(Self::PLAIN))
    }

    /// Sets this level as the one that kernels run at, for comparing their bytes; false when a kernel has run already.
    pub fn make_best(self) -> bool {
        BEST.set(self).is_ok()
    }

    /// All levels of this processor, the baseline first: tests run their kernels with each.
    pub fn available() -> Vec<Self> {
        let mut levels = vec![Self::PLAIN];
        #[cfg(target_arch = "x86_64")]
        {
            let bits = std::arch::is_x86_feature_detected!("bmi1")
                && std::arch::is_x86_feature_detected!("bmi2")
                && std::arch::is_x86_feature_detected!("lzcnt");
            if !(bits && std::arch::is_x86_feature_detected!("avx2")) {
                return levels;
            }
            levels.push(Self(Kind::Avx2));
            let wide =
                std::arch::is_x86_feature_detected!("avx512f") && std::arch::is_x86_feature_detected!("avx512bw");
            let full =
                std::arch::is_x86_feature_detected!("avx512dq") && std::arch::is_x86_feature_detected!("avx512vl");
            if wide && full {
                levels.push(Self(Kind::Avx512));
            }
        }
        levels
    }

    /// Name for tables of benchmarks.
    pub fn name(self) -> &'static str {
        match self.0 {
            Kind::Plain => "plain",
            Kind::Avx2 => "avx2",
            Kind::Avx512 => "avx512",
        }
    }

    #[doc(hidden)]
    pub fn kind(self) -> Kind {
        self.0
    }
}

/// Compiles a kernel once per [`Level`]: `simd_kernel! { /// Doc. pub fn name(a: &[f32], b: &mut [f32]) { .. } }`
/// becomes `name(level, a, b)`. Functions that the body calls must be `#[inline(always)]`.
#[macro_export]
macro_rules! simd_kernel {
    ($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $ty:ty),* $(,)?) $(-> $ret:ty)? $body:block) => {
        $(#[$meta])*
        $vis fn $name(level: $crate::simd::Level, $($arg: $ty),*) $(-> $ret)? {
            #[inline(always)]
            fn kernel($($arg: $ty),*) $(-> $ret)? $body
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt")]
            fn avx2($($arg: $ty),*) $(-> $ret)? {
                kernel($($arg),*)
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,bmi1,bmi2,lzcnt")]
            fn avx512($($arg: $ty),*) $(-> $ret)? {
                kernel($($arg),*)
            }
            match level.kind() {
                // SAFETY: a level above the baseline exists only after its features were detected.
                #[cfg(target_arch = "x86_64")]
                $crate::simd::Kind::Avx512 => unsafe { avx512($($arg),*) },
                // SAFETY: as above.
                #[cfg(target_arch = "x86_64")]
                $crate::simd::Kind::Avx2 => unsafe { avx2($($arg),*) },
                _ => kernel($($arg),*),
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    simd_kernel! {
        /// Sums of products, lane by lane.
        fn multiply_add(a: &[f32; 64], b: &[f32; 64], sum: &mut [f32; 64]) {
            for i in 0..64 {
                sum[i] += a[i] * b[i];
            }
        }
    }

    #[test]
    fn all_levels_give_the_same_bits() {
        let a: [f32; 64] = core::array::from_fn(|i| 1.0 / (i as f32 + 3.0));
        let b: [f32; 64] = core::array::from_fn(|i| 7.1 * i as f32 - 100.3);
        let run = |level: Level| {
            let mut sum = a;
            multiply_add(level, &a, &b, &mut sum);
            sum.map(f32::to_bits)
        };
        for level in Level::available() {
            assert_eq!(run(level), run(Level::PLAIN), "{}", level.name());
        }
        assert_eq!(Level::available().last(), Some(&Level::best()));
    }
}

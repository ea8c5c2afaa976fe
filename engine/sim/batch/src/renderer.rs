//! Batches of pictures on all threads of a pool.

use crate::outputs::Outputs;
use crate::painter::Painter;
use crate::view::BatchView;
use cosfly_frames::simd::Level;
use rayon::prelude::*;
use std::sync::Mutex;

/// Draws batches of pictures of one size. Owns all scratch memory: nothing is allocated once buffers have grown.
pub struct BatchRenderer {
    width: usize,
    height: usize,
    painters: Vec<Painter>,
}

impl BatchRenderer {
    /// A renderer for pictures of `width` x `height` pixels on one thread.
    pub fn new(width: u32, height: u32) -> Self {
        Self::on_threads(width, height, 1)
    }

    /// A renderer that draws up to `threads` pictures at a time on the threads of the rayon pool that calls it. The
    /// number changes no byte.
    pub fn on_threads(width: u32, height: u32, threads: usize) -> Self {
        let (width, height) = (width as usize, height as usize);
        Self { width, height, painters: (0..threads.max(1)).map(|_| Painter::new(width, height)).collect() }
    }

    /// Pixels of a picture.
    pub fn pixels(&self) -> usize {
        self.width * self.height
    }

    /// Draws with these vector instructions from now on, to compare their bytes: they are the same.
    pub fn set_level(&mut self, level: Level) {
        self.painters.iter_mut().for_each(|painter| painter.set_level(level));
    }

    /// Draws a picture of each view into the buffers.
    ///
    /// # Panics
    /// Where a buffer does not hold exactly the pixels of all views ([`Outputs::mismatch`] tells before).
    pub fn render(&mut self, views: &[BatchView<'_>], mut outputs: Outputs<'_>) {
        let pixels = self.pixels();
        if let Some((channel, length)) = outputs.mismatch(views.len() * pixels) {
            panic!(
                "the buffer `{channel}` has {length} elements; {} views of {pixels} pixels need {}",
                views.len(),
                views.len() * pixels
            );
        }
        let threads = self.painters.len().min(views.len());
        if threads <= 1 {
            let Some(painter) = self.painters.first_mut() else { return };
            for view in views {
                painter.paint(view, &mut outputs.split_off(pixels));
            }
            return;
        }
        // Each painter takes the next picture when it is done with one.
        let rest = Mutex::new((views.iter(), outputs));
        let next = || {
            let mut rest = rest.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            let view = rest.0.next()?;
            Some((view, rest.1.split_off(pixels)))
        };
        self.painters[..threads].par_iter_mut().with_max_len(1).for_each(|painter| {
            while let Some((view, mut outputs)) = next() {
                painter.paint(view, &mut outputs);
            }
        });
    }
}

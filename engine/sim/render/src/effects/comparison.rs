//! The frames beside the one that is taken, drawn for channels that compare them.

use super::shot::{Neighbours, setup_at};
use crate::renderer::flow::{OtherFrame, SeenThrough};
use crate::renderer::{FrameParts, Renderer};
use crate::scene::Scene;
use crate::setup::FrameSetup;
use cosfly_domain::channels::FlowTo;
use cosfly_domain::{RollingShutter, Weather};
use cosfly_figures::FigureInPicture;
use std::ops::Range;

/// What the frames beside one show; its buffers.
#[derive(Default)]
pub(super) struct Comparison {
    scout: Option<Renderer>,
    frames: [(OtherFrame, bool); 2],
    bystanders: Vec<FigureInPicture>,
}

const BOTH: [FlowTo; 2] = [FlowTo::Previous, FlowTo::Next];

impl Comparison {
    /// Draws what is nearest in each neighbour that a channel of `renderer` looks at.
    pub fn look(
        &mut self,
        (renderer, scene): (&Renderer, &Scene),
        (weather, neighbours): (&Weather, &Neighbours<'_>),
        rolling: &RollingShutter,
    ) {
        let Self { scout, frames, bystanders } = self;
        for (to, (frame, is_wanted)) in BOTH.into_iter().zip(frames) {
            frame.clear();
            *is_wanted = renderer.has_flow(to);
            let beside = match to {
                FlowTo::Previous => neighbours.previous,
                FlowTo::Next => neighbours.next,
            };
            let Some(beside) = beside.filter(|_| *is_wanted) else { continue };
            let scout = scout.get_or_insert_with(|| Renderer::new(renderer.camera()));
            for (rows, moment_s) in rolling.strips(renderer.camera().height as usize) {
                let setup = setup_at(weather, &beside, moment_s, bystanders);
                scout.render_parts(scene, &setup, FrameParts::Visibility);
                scout.remember(&setup, rows, frame);
            }
        }
    }

    /// Draws the channels that compare the frame, of rows that `renderer` has just drawn from `setup`.
    pub fn draw(&self, renderer: &mut Renderer, setup: &FrameSetup<'_>, rows: &Range<usize>, finished: &SeenThrough) {
        for (to, (frame, is_wanted)) in BOTH.into_iter().zip(&self.frames) {
            if *is_wanted {
                renderer.draw_flow(setup, rows.clone(), (to, frame), finished);
            }
        }
    }
}

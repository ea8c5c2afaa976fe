//! Charts and drawings. The same input gives the same bytes on every machine.
//!
//! * SVG documents of their own: [`document`] with its shapes, [`bars`] and [`lines`] as panels of it, [`axis`] for marks from 0.
//! * Figures inside of HTML pages, styled by the page: [`histogram`], [`convergence`], [`strip`], on [`axes`].
//! * Pictures of pixels: [`canvas`], with letters of [`font`].
//! * [`distribution`]: values that are counted and merged.
//! * [`statistics`]: bins, quantiles, round steps. [`text`]: text and numbers in documents.

pub mod axes;
pub mod axis;
pub mod bars;
pub mod canvas;
pub mod convergence;
pub mod distribution;
pub mod document;
pub mod font;
pub mod histogram;
pub mod lines;
pub mod statistics;
pub mod strip;
pub mod text;

//! The report as text.

use super::measure::{RenderReport, RenderRow};
use cosfly_render::PictureLook;
use std::fmt;

impl fmt::Display for RenderReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} x {}, {} views per town; CPU milliseconds per frame on one core",
            self.width, self.height, self.views
        )?;
        let headings =
            ["visible", "+ ids", "+ colour", "drawn", "rgb", "depth", "ids", "previews", "pack", "log", "whole"];
        write!(f, "{:14} {:>6} {:20}", "town", "boxes", "weather")?;
        headings.iter().try_for_each(|heading| write!(f, " {heading:>8}"))?;
        writeln!(f, " {:>8}", "kB")?;
        for row in &self.rows {
            let t = &row.times;
            write!(f, "{:14} {:>6} {:20}", row.town, row.boxes, row.title())?;
            for ms in [
                t.visibility_ms,
                t.ids_ms,
                t.colour_ms,
                t.render_ms(),
                t.encode_rgb_ms,
                t.encode_depth_ms,
                t.encode_ids_ms,
                t.encode_previews_ms,
                t.pack_ms,
                t.log_ms,
                t.whole_ms(),
            ] {
                write!(f, " {ms:>8.2}")?;
            }
            writeln!(f, " {:>8.0}", 1e-3 * t.log_bytes)?;
        }
        writeln!(
            f,
            "`pack` encodes all channels, checks, hashes and writes them; `log` makes the finished log of it.\n"
        )?;
        for t in &self.throughput {
            writeln!(
                f,
                "{} look: {} frames on {} threads, drawn, encoded and written as logs: {:.1} frames/s",
                look_name(t.look),
                t.frames,
                t.threads,
                t.frames_per_s
            )?;
            writeln!(
                f,
                "{:.1} ms of CPU a frame, which is {:.1} frames/s on that many idle cores; {:.0} kB a frame\n",
                t.cpu_ms,
                t.undisturbed_frames_per_s,
                1e-3 * t.bytes
            )?;
        }
        self.distances(f)
    }
}

impl RenderRow {
    /// Weather and look.
    fn title(&self) -> String {
        match self.look {
            PictureLook::Full => self.weather.clone(),
            PictureLook::Simple => format!("{}, simple", self.weather),
        }
    }
}

fn look_name(look: PictureLook) -> &'static str {
    match look {
        PictureLook::Full => "full",
        PictureLook::Simple => "simple",
    }
}

impl RenderReport {
    fn distances(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let m = &self.machine;
        writeln!(
            f,
            "one core fills memory at {:.1} GB/s (a frame's channels: {:.1}), copies at {:.1} GB/s, tests {:.0} M depths/s",
            m.far_fill_gbps, m.frame_fill_gbps, m.far_copy_gbps, m.depth_tests_mpps
        )?;
        writeln!(
            f,
            "a frame's channels written once: {:.2} ms; one depth test per pixel: {:.2} ms",
            m.frame_fill_ms, m.frame_depth_test_ms
        )?;
        for row in &self.rows {
            let t = &row.times;
            writeln!(
                f,
                "{:14} {:20} visibility {:>5.1} x the depth tests; depth and ids {:>5.1} x the writing; all channels {:>6.1} x",
                row.town,
                row.title(),
                t.visibility_ms / m.frame_depth_test_ms,
                (t.visibility_ms + t.ids_ms) / m.frame_fill_ms,
                t.render_ms() / m.frame_fill_ms
            )?;
        }
        Ok(())
    }
}

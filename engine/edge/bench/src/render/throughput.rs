//! Whole frames a second on several threads: drawn, encoded, packed, and written as finished logs.

use super::RenderOptions;
use super::flight::{DT_S, StoredFile, flight};
use super::views::{Ground, View};
use crate::clock::{process_cpu_s, wall_s};
use cosfly_dataset::{FramePackReader, FramePackWriter, PackHeader, write_log};
use cosfly_diagnose::Result;
use cosfly_render::{FrameSetup, Renderer, Weather};
use serde::Serialize;
use std::io::BufReader;

/// How fast finished frames come out.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Throughput {
    /// Threads that worked, one flight each.
    pub threads: usize,
    /// Frames of all flights.
    pub frames: usize,
    /// Frames per second of wall time, whatever else ran on the machine.
    pub frames_per_s: f64,
    /// CPU milliseconds of a frame, all threads and the system's share included.
    pub cpu_ms: f64,
    /// Frames per second that the threads would give undisturbed.
    pub undisturbed_frames_per_s: f64,
    /// Bytes of a frame on disk.
    pub bytes: f64,
}

/// Follows the walkers of `ground` on all threads at once, each in the next weather of the list.
pub fn throughput(ground: &Ground, options: &RenderOptions<'_>) -> Result<Throughput> {
    let threads = options.threads.max(1);
    let frames = options.flight_frames.max(1);
    // Once before, so that code, fonts of memory and the disk's cache are warm.
    fly(ground, &options.weathers[0], ground.views.len().min(frames), 0, options)?;
    let (began_s, cpu_began_s) = (wall_s(), process_cpu_s());
    let written = std::thread::scope(|scope| -> Result<u64> {
        let workers: Vec<_> = (0..threads)
            .map(|thread| {
                let weather = &options.weathers[thread % options.weathers.len()];
                scope.spawn(move || fly(ground, weather, frames, thread, options))
            })
            .collect();
        workers.into_iter().map(|worker| worker.join().expect("a flight does not panic")).sum()
    })?;
    let (spent_s, cpu_s) = (wall_s() - began_s, process_cpu_s() - cpu_began_s);
    let total = threads * frames;
    Ok(Throughput {
        threads,
        frames: total,
        frames_per_s: total as f64 / spent_s,
        cpu_ms: 1e3 * cpu_s / total as f64,
        undisturbed_frames_per_s: threads as f64 * total as f64 / cpu_s,
        bytes: written as f64 / total as f64,
    })
}

/// One flight from nothing to its log; how many bytes that has.
fn fly(ground: &Ground, weather: &Weather, frames: usize, thread: usize, options: &RenderOptions<'_>) -> Result<u64> {
    let path = |kind: &str| options.scratch.join(format!("flight-{thread}.{kind}"));
    let header =
        PackHeader::new(ground.camera.width, ground.camera.height, ground.largest_instance(), options.encoding, DT_S);
    let mut renderer = Renderer::new(ground.camera);
    let mut pack = FramePackWriter::new(StoredFile::create(&path("pack"))?, &header)?;
    let shown: Vec<View> = (0..frames).map(|frame| ground.walked(frame, DT_S)).collect();
    let mut views = Vec::with_capacity(frames);
    for view in &shown {
        let setup = FrameSetup { pose: view.pose, weather, target: Some(view.target), others: &[] };
        let rendered = renderer.render(&ground.scene, &setup);
        pack.frame(rendered.images)?;
        views.push(rendered.target_view);
    }
    pack.finish()?.finish();
    let record = flight(ground, weather, &shown, views);
    let mut pack = FramePackReader::new(BufReader::new(StoredFile::open(&path("pack"))?))?;
    let mut output = StoredFile::create(&path("mcap"))?;
    let log = write_log(&mut output, &record, &mut pack, &[], &ground.town, &|| Ok(()))?;
    output.finish();
    Ok(log.bytes)
}

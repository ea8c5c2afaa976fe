//! Throughput of several threads: frames drawn, encoded, packed, and written as finished logs.

use super::flight::{DT_S, StoredFile, flight};
use super::options::RenderOptions;
use super::views::{Ground, View};
use crate::clock::{process_cpu_s, wall_s};
use cosfly_diagnose::Result;
use cosfly_domain::Weather;
use cosfly_render::{FrameSetup, PictureLook, Renderer};
use cosfly_write::{FramePackReader, FramePackWriter, PackHeader, write_log};
use serde::Serialize;
use std::io::BufReader;

/// Throughput of finished frames.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Throughput {
    /// Look of the colours.
    pub look: PictureLook,
    /// Number of threads; each made one flight in every weather.
    pub threads: usize,
    /// Number of frames of all flights.
    pub frames: usize,
    /// Frames per second of wall time, on the machine as loaded.
    pub frames_per_s: f64,
    /// CPU time per frame, milliseconds, of all threads and including the system's share.
    pub cpu_ms: f64,
    /// Frames per second of CPU time, as on an idle machine.
    pub undisturbed_frames_per_s: f64,
    /// Bytes per frame on disk.
    pub bytes: f64,
}

/// Makes logs of flights on all threads at once, one flight per thread, in one weather after the other.
pub fn throughput(
    ground: &Ground,
    flights: &[Vec<View>],
    look: PictureLook,
    options: &RenderOptions<'_>,
) -> Result<Throughput> {
    let threads = flights.len();
    // One run to warm up code, memory pages and the disk's cache.
    let warm = &flights[0][..flights[0].len().min(20)];
    fly(ground, (&options.weathers[0], look), warm, 0, options)?;
    let (began_s, cpu_began_s) = (wall_s(), process_cpu_s());
    let written = std::thread::scope(|scope| -> Result<u64> {
        let workers: Vec<_> = (flights.iter().enumerate())
            .map(|(thread, shown)| {
                let fly = move |weather| fly(ground, (weather, look), shown, thread, options);
                scope.spawn(move || options.weathers.iter().map(fly).sum::<Result<u64>>())
            })
            .collect();
        workers.into_iter().map(|worker| worker.join().expect("a flight does not panic")).sum()
    })?;
    let (spent_s, cpu_s) = (wall_s() - began_s, process_cpu_s() - cpu_began_s);
    let total = options.weathers.len() * flights.iter().map(Vec::len).sum::<usize>();
    Ok(Throughput {
        look,
        threads,
        frames: total,
        frames_per_s: total as f64 / spent_s,
        cpu_ms: 1e3 * cpu_s / total as f64,
        undisturbed_frames_per_s: threads as f64 * total as f64 / cpu_s,
        bytes: written as f64 / total as f64,
    })
}

/// Makes one flight's log; returns its size in bytes.
fn fly(
    ground: &Ground,
    (weather, look): (&Weather, PictureLook),
    shown: &[View],
    thread: usize,
    options: &RenderOptions<'_>,
) -> Result<u64> {
    let path = |kind: &str| options.scratch.join(format!("flight-{thread}.{kind}"));
    let header =
        PackHeader::new(ground.camera.width, ground.camera.height, ground.largest_instance(), options.encoding, DT_S);
    let mut renderer = Renderer::new(ground.camera);
    renderer.set_look(look);
    let mut pack = FramePackWriter::new(StoredFile::create(&path("pack"))?, &header)?;
    let mut views = Vec::with_capacity(shown.len());
    for view in shown {
        let setup = FrameSetup { pose: view.pose, weather, target: Some(view.target), others: &[] };
        let rendered = renderer.render(&ground.scene, &setup);
        pack.frame(rendered.images)?;
        views.push(rendered.target_view);
    }
    pack.finish()?.finish();
    let record = flight(ground, weather, shown, views);
    let mut pack = FramePackReader::new(BufReader::new(StoredFile::open(&path("pack"))?))?;
    let mut output = StoredFile::create(&path("mcap"))?;
    let log = write_log(&mut output, &record, &mut pack, &[], &[], &ground.town, &|| Ok(()))?;
    output.finish();
    Ok(log.record.bytes)
}

//! Table `target_losses`: one row for each stretch of frames that show no pixel of the target.

use crate::flight_rows::FlightRows;
use crate::report::VerifyReport;
use crate::rows::PlacedFrame;
use crate::tables::LossRow;
use cosfly_diagnose::counted;

/// Seconds that pass through a product.
const TOLERANCE: f64 = 1e-9;

/// The rows of a flight are those that its frames give; a target without a body has none.
pub fn check(it: &FlightRows<'_>, report: &mut VerifyReport) {
    let id = &it.flight.trajectory_id;
    let is_lost = |frame: &PlacedFrame| frame.visible_pixels == 0 && it.flight.target_kind.is_some();
    let stretches = it.frames.chunk_by(|a, b| is_lost(a) == is_lost(b)).filter(|frames| is_lost(&frames[0]));
    let stretches: Vec<&[PlacedFrame]> = stretches.collect();
    if stretches.len() != it.losses.len() {
        let message = format!(
            "{}; in {} stretches of frames no pixel shows it",
            counted(it.losses.len(), "row"),
            stretches.len()
        );
        report.find("data/target_losses", format!("`{id}`"), "verify-loss", message);
        return;
    }
    for (frames, row) in stretches.into_iter().zip(it.losses) {
        if let Some(message) = problem(it, frames, row) {
            report.find(&row.place.0, format!("row {}, `{id}`", row.place.1), "verify-loss", message);
        }
    }
}

/// Difference between the row and the frames of the stretch, in words.
fn problem(it: &FlightRows<'_>, lost: &[PlacedFrame], row: &LossRow) -> Option<String> {
    let (start, count) = (lost[0].frame, lost.len() as u32);
    let end = start + count;
    let out_of_view = lost.iter().filter(|frame| !frame.in_view).count() as u32;
    let seen_again = it.frames.get(end as usize).map(|frame| frame.look_alikes);
    let frames_with = |instance: u32| lost.iter().filter(|frame| frame.occluder_instance == instance).count();
    let cause = lost.iter().map(|frame| frame.occluder_instance).max_by_key(|instance| frames_with(*instance))?;
    if row.frames != (start, end) {
        return Some(format!("frames {:?}; no pixel shows it in frames {:?}", row.frames, (start, end)));
    }
    if (row.duration_s - f64::from(count) * it.flight.dt_s).abs() > TOLERANCE {
        return Some(format!(
            "`duration_s` is {}; it is of {}, {} s each",
            row.duration_s,
            counted(count, "frame"),
            it.flight.dt_s
        ));
    }
    if row.frames_out_of_view != out_of_view {
        return Some(format!("`frames_out_of_view` is {}; the frames give {out_of_view}", row.frames_out_of_view));
    }
    if (row.reacquired, row.look_alikes) != (seen_again.is_some(), seen_again) {
        let said = (row.reacquired, row.look_alikes);
        return Some(format!("`reacquired` and `look_alikes` are {said:?}; the frame after it gives {seen_again:?}"));
    }
    (frames_with(row.cause_instance) < frames_with(cause))
        .then(|| format!("`cause_instance` is {}; most frames have the occluder {cause}", row.cause_instance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{files, rows, tables};
    use cosfly_sample as sample;
    use cosfly_schema::{DatasetConfig, EncodingConfig};
    use std::collections::BTreeMap;

    #[test]
    fn losses_that_the_frames_do_not_have_are_found() {
        let home = tempfile::tempdir().unwrap();
        let mut flights = sample::flights();
        // Out of view in frame 0, hidden in frames 2 and 3.
        for (frame, in_view) in [(0, false), (2, true), (3, true)] {
            let view = &mut flights[0].record.views[frame];
            (view.in_view, view.visible_box, view.pixels, view.visible_by_pixels) = (in_view, None, 0, 0.0);
            view.full_box = view.full_box.filter(|_| in_view);
        }
        let id = flights[0].record.trajectory_id.clone();
        sample::write_flights(home.path(), &DatasetConfig::default(), EncodingConfig::default(), flights).unwrap();
        let mut report = VerifyReport::default();
        let files = files::check(home.path(), &Default::default(), &mut report).unwrap();
        let small = tables::read(home.path(), &files, &mut report);
        let mut groups = vec![];
        for file in files.sound_below("data/frames/") {
            rows::frames(&home.path().join(file), &mut |frames| groups.push(frames)).unwrap();
        }
        let frames = groups.iter().find(|frames| frames[0].trajectory_id == id).unwrap();
        let number = small.flights.number(&id).unwrap();
        let found = |losses: &[LossRow]| {
            let mut report = VerifyReport::default();
            let it = FlightRows {
                file: "",
                flight: small.flights.at(number),
                frames,
                bodies_file: "",
                bodies: &[],
                in_space: None,
                objects: None,
                pairs: &BTreeMap::new(),
                losses,
                extent: None,
                expert: None,
                film: None,
            };
            check(&it, &mut report);
            report.findings.len()
        };
        let sound = &small.losses[&number];
        assert_eq!(sound.iter().map(|row| row.frames).collect::<Vec<_>>(), [(0, 1), (2, 4)]);
        assert_eq!((found(sound), found(&sound[1..]), found(&[])), (0, 1, 1));
        let spoils: [fn(&mut LossRow); 6] = [
            |row| row.frames.1 += 1,
            |row| row.duration_s += 0.5,
            |row| row.frames_out_of_view += 1,
            |row| row.reacquired = false,
            |row| row.look_alikes = Some(7),
            |row| row.cause_instance = 77,
        ];
        for spoil in spoils {
            let mut losses = sound.clone();
            spoil(&mut losses[1]);
            assert_eq!(found(&losses), 1);
        }
    }
}

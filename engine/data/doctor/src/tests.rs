//! Planted faults, each found and named.

use crate::{Examination, Quota, examine};
use cosfly_sample as sample;
use cosfly_sample::SampleFlight;
use cosfly_schema::{DatasetConfig, EncodingConfig};
use std::collections::BTreeSet;
use std::path::Path;

fn write(folder: &Path, change: &dyn Fn(&mut SampleFlight)) {
    let mut flights = sample::flights();
    flights.iter_mut().for_each(|flight| {
        // The sample's instructions are no true ones.
        flight.captions.clear();
        change(flight);
    });
    sample::write_flights(folder, &DatasetConfig::default(), EncodingConfig::default(), flights)
        .expect("it is written");
}

fn examined(folder: &Path) -> Examination {
    examine(folder, &[Quota { wanted: 0.2, lost_s: (2.0, 4.0) }], &mut |_, _| {}).expect("it can be examined")
}

fn names(folder: &Path) -> BTreeSet<&'static str> {
    examined(folder).flags.iter().map(|flag| flag.name).collect()
}

#[track_caller]
fn check_planted(name: &str, change: &dyn Fn(&mut SampleFlight)) {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), change);
    let found = names(folder.path());
    assert!(found.contains(name), "`{name}` is not among {found:?}");
}

/// The first file below `folder` whose path has an ending.
fn file(folder: &Path, part: &str) -> std::path::PathBuf {
    let files = cosfly_episodes::files_below(folder).expect("a list");
    files.into_iter().find(|path| path.to_string_lossy().contains(part)).expect("such a file")
}

#[test]
fn nothing_is_wrong_with_sound_data() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), &|_| {});
    let found = examined(folder.path());
    assert_eq!(found.flags, []);
    assert_eq!((found.episodes, found.frames, found.kept.len()), (4, 20, 4));
    assert_eq!(found.quotas[0].1, 0.0);
    assert!(!found.has_damage());
}

#[test]
fn a_yaw_with_the_wrong_sign_is_named() {
    check_planted("yaw-sign", &|flight| {
        flight.record.trajectory.poses_in_world.iter_mut().for_each(|pose| pose.yaw_rad = -pose.yaw_rad);
    });
}

#[test]
fn a_pitch_with_the_wrong_sign_is_named() {
    check_planted("pitch-sign", &|flight| {
        flight.record.trajectory.poses_in_world.iter_mut().for_each(|pose| pose.pitch_rad = -pose.pitch_rad);
    });
}

#[test]
fn depth_in_millimetres_is_named() {
    check_planted("depth-unit", &|flight| {
        flight.images.iter_mut().flat_map(|images| &mut images.depth_m).for_each(|depth| *depth *= 1000.0);
    });
}

#[test]
fn pictures_that_repeat_are_named() {
    check_planted("duplicate-frames", &|flight| flight.images[2] = flight.images[1].clone());
}

#[test]
fn poses_that_freeze_are_named() {
    check_planted("frozen-frames", &|flight| {
        let trajectory = &mut flight.record.trajectory;
        (1..4).for_each(|frame| {
            trajectory.poses_in_world[frame] = trajectory.poses_in_world[0];
            trajectory.track.states[frame] = trajectory.track.states[0];
        });
    });
}

#[test]
fn displaced_twins_are_sound_at_any_rate_and_a_jump_beyond_their_displacement_is_named() {
    for dt_s in [0.5, 0.1, 0.01] {
        let displaced = |more_m: f64| {
            let folder = tempfile::tempdir().expect("a folder");
            write(folder.path(), &|flight| {
                let trajectory = &mut flight.record.trajectory;
                trajectory.track.dt_s = dt_s;
                let Some(twin) = &mut trajectory.perturbation else { return };
                // Up and down by 3 m, as the paper's twins, and further in the poses alone.
                for (frame, pose) in trajectory.poses_in_world.iter_mut().enumerate() {
                    let up_m = if frame % 2 == 0 { 3.0 } else { -3.0 };
                    pose.position_in_world.z += up_m + if frame == 2 { more_m } else { 0.0 };
                    twin.frames[frame].drone_offset_in_world = cosfly_frames::DVec3::Z * up_m;
                }
            });
            names(folder.path()).contains("pose-jump")
        };
        assert!(!displaced(0.0), "{dt_s} s");
        assert!(displaced(45.0 * dt_s + 1.0), "{dt_s} s");
    }
}

#[test]
fn a_town_whose_walks_are_kilometres_from_its_objects_is_named() {
    check_planted("town-apart", &|flight| {
        let far = cosfly_frames::DVec3::new(393_706.0, 0.0, 0.0);
        let trajectory = &mut flight.record.trajectory;
        trajectory.poses_in_world.iter_mut().for_each(|pose| pose.position_in_world += far);
        trajectory.track.states.iter_mut().for_each(|state| state.feet_in_world += far);
    });
}

#[test]
fn an_instruction_that_is_not_true_is_named() {
    check_planted("caption-mismatch", &|flight| {
        flight.captions = sample::flights()[0].captions.clone();
    });
}

#[test]
fn a_truncated_table_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), &|_| {});
    let table = file(folder.path(), "data/frames/");
    let bytes = std::fs::read(&table).expect("the table");
    std::fs::write(&table, &bytes[..bytes.len() / 2]).expect("half of it");
    let found = examined(folder.path());
    let flag = found.flags.iter().find(|flag| flag.name == "parquet-damaged").expect("a flag");
    assert!(flag.place.starts_with("data/frames/"), "{flag}");
    assert!(found.has_damage());
}

#[test]
fn a_flipped_byte_in_a_log_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), &|_| {});
    let log = file(folder.path(), "perturbed-p00001.mcap");
    let mut bytes = std::fs::read(&log).expect("the log");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x40;
    std::fs::write(&log, bytes).expect("the damaged log");
    let found = examined(folder.path());
    let flag = found.flags.iter().find(|flag| flag.name == "log-damaged").expect("a flag");
    assert!(flag.place.ends_with("perturbed-p00001.mcap"), "{flag}");
}

#[test]
fn pictures_and_tables_of_two_versions_are_named() {
    let folders = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let moved = |flight: &mut SampleFlight| {
        flight.record.trajectory.poses_in_world.iter_mut().for_each(|pose| pose.position_in_world.y += 0.4);
    };
    let fewer_pixels = |flight: &mut SampleFlight| {
        flight.record.views.iter_mut().for_each(|view| view.pixels = view.pixels.saturating_sub(1));
    };
    write(folders[0].path(), &|_| {});
    for other in [&moved as &dyn Fn(&mut SampleFlight), &fewer_pixels] {
        write(folders[1].path(), other);
        for part in ["expert-p00000.mcap", "perturbed-p00001.mcap"] {
            std::fs::copy(file(folders[1].path(), part), file(folders[0].path(), part)).expect("a copy");
        }
        let found = examined(folders[0].path());
        let flagged: Vec<_> = found.flags.iter().filter(|flag| flag.name == "mixed-versions").collect();
        assert_eq!(flagged.len(), 2, "{:?}", found.flags);
        assert!(flagged[0].place == "expert-p00000" && flagged[0].message.contains("one run"), "{}", flagged[0]);
    }
}

#[test]
fn a_flight_in_two_splits_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), &|_| {});
    let table = file(folder.path(), "data/trajectories/");
    let split = if table.to_string_lossy().contains("test-") { "val" } else { "test" };
    std::fs::copy(&table, table.with_file_name(format!("{split}-00000-of-00009.parquet"))).expect("a copy");
    assert!(names(folder.path()).contains("split-leak"));
}

#[test]
fn an_examination_that_is_stopped_ends_between_frames() {
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), &|_| {});
    let stop = cosfly_diagnose::Stop::of(Arc::new(AtomicBool::new(true)));
    let refusal = crate::examine_given(folder.path(), &[], &crate::HeldAgainst::default(), (&stop, &mut |_, _| {}))
        .expect_err("stopped");
    assert_eq!(refusal.fault, cosfly_diagnose::Fault::Stopped);
}

#[test]
fn a_folder_of_no_known_layout_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(examine(folder.path(), &[], &mut |_, _| {}).expect_err("refused").code, "doctor-layout");
}

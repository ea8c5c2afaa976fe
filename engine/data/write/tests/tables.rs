//! Tables read back as they were written, twice the same.

use arrow_array::types::Float64Type;
use arrow_array::{Array, FixedSizeListArray, Float64Array, StringArray};
use cosfly_sample as sample;
use cosfly_schema::tables::{Column, DatasetItem, Membership, Table, Trajectories, Windows, of_trajectories};
use cosfly_schema::{LogRecord, PreviewStrip, Role, Split, TownLayout};
use cosfly_windows::{Difficulty, WindowShape};
use cosfly_write::derive::derive;
use cosfly_write::table_file::TableWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::sync::Arc;

const WINDOWS: WindowShape = WindowShape { history: 2, horizon: 2, stride: 1 };

fn item(role: Role) -> DatasetItem {
    let flight = sample::flight(0, role);
    let log = LogRecord {
        trajectory_id: flight.record.trajectory_id.clone(),
        role,
        pedestrian_id: flight.record.pedestrian_id.clone(),
        town: "plain".into(),
        frames: 5,
        messages: 70,
        bytes: 9,
        sha256: "00".into(),
    };
    DatasetItem {
        derived: derive(&flight.record, &Default::default(), &WINDOWS),
        record: flight.record,
        captions: flight.captions,
        previews: PreviewStrip { jpegs: vec![vec![1, 2]; 5] },
        log,
        mcap_path: "mcap/x".into(),
        expert: (role == Role::Perturbed).then(|| Box::new(sample::flight(0, Role::Expert).record)),
        membership: Membership {
            split: Split::Train,
            split_group: "plain/p00000".into(),
            is_seen: true,
            subset_rank: 0.5,
        },
        layout: Arc::new(TownLayout::of(&sample::town())),
        windows: WINDOWS,
    }
}

fn write(table: &Table<DatasetItem>, items: &[DatasetItem]) -> Vec<u8> {
    let mut bytes = vec![];
    let mut writer = TableWriter::new(table, &mut bytes).unwrap();
    items.iter().for_each(|item| writer.append(item).unwrap());
    writer.finish().unwrap();
    bytes
}

#[test]
fn every_table_has_its_rows_and_the_same_bytes_twice() {
    let items = [item(Role::Expert), item(Role::Perturbed)];
    for (table, rows) in of_trajectories().iter().zip([2, 10, 10, 4, 1, 10, 0, 0, 2, 16]) {
        let bytes = write(table, &items);
        assert!(bytes == write(table, &items), "{}", table.name);
        let reader = ParquetRecordBatchReaderBuilder::try_new(foxglove::bytes::Bytes::from(bytes)).unwrap();
        assert_eq!(reader.metadata().file_metadata().created_by(), Some("cosfly"));
        let found: usize = reader.build().unwrap().map(|batch| batch.unwrap().num_rows()).sum();
        assert_eq!(found, rows, "{}", table.name);
    }
}

#[test]
fn frames_hold_poses_in_degrees_and_no_action_on_the_last() {
    let item = item(Role::Expert);
    let table = of_trajectories().remove(1);
    let bytes = foxglove::bytes::Bytes::from(write(&table, std::slice::from_ref(&item)));
    let batch = ParquetRecordBatchReaderBuilder::try_new(bytes).unwrap().build().unwrap().next().unwrap().unwrap();
    let yaw = batch.column_by_name("drone_yaw_deg").unwrap().as_any().downcast_ref::<Float64Array>().unwrap();
    assert_eq!(yaw.value(1), item.record.trajectory.poses_in_world[1].yaw_rad.to_degrees());
    let action =
        batch.column_by_name("action_in_world").unwrap().as_any().downcast_ref::<FixedSizeListArray>().unwrap();
    assert!(action.is_null(4) && !action.is_null(3));
    let first = action.value(0);
    let first = arrow_array::cast::as_primitive_array::<Float64Type>(&first);
    let poses = &item.record.trajectory.poses_in_world;
    assert_eq!(first.value(0), poses[1].position_in_world.x - poses[0].position_in_world.x);
    let ids = batch.column_by_name("trajectory_id").unwrap().as_any().downcast_ref::<StringArray>().unwrap();
    assert_eq!(ids.value(0), "expert-p00000");
}

#[test]
fn a_number_that_is_not_finite_is_refused_with_its_place() {
    let mut item = item(Role::Expert);
    item.record.trajectory.clearance_m[3] = f64::NAN;
    let table = of_trajectories().remove(1);
    let error = TableWriter::new(&table, vec![]).unwrap().append(&item).unwrap_err();
    assert!(error.message.contains("column `clearance_m`, row 3 of table `frames`"), "{error}");
}

fn windows_table() -> Table<DatasetItem> {
    of_trajectories().into_iter().find(|table| table.name == "windows").unwrap()
}

fn value<T>(column: Column<DatasetItem, T>, item: &DatasetItem, row: usize) -> T {
    (column.cell)(item, row)
}

#[test]
fn windows_lead_from_the_disturbed_pose_to_the_experts() {
    let item = item(Role::Perturbed);
    let (own, expert) = (&item.record.trajectory.poses_in_world, &item.expert.as_ref().unwrap().trajectory);
    // The twin is displaced in frame 2 alone, which is the current frame of the window that starts at 1.
    let offset = expert.poses_in_world[2].position_in_world - own[2].position_in_world;
    let correction = value(Windows::correction_in_world, &item, 1);
    assert_eq!((correction.len(), &correction[..6]), (12, &[0.0; 6][..]));
    assert!((f64::from(correction[6]) - offset.x).abs() < 1e-6 && offset.x != 0.0);
    let deltas = value(Windows::waypoint_deltas_in_world, &item, 1);
    let expected = expert.poses_in_world[3].position_in_world - own[2].position_in_world;
    assert!((f64::from(deltas[0]) - expected.x).abs() < 1e-6 && deltas.len() == 12);
    assert_eq!(deltas[6..], value(Windows::expert_steps_in_world, &item, 1)[12..]);
    assert_eq!(value(Windows::input_boxes_px, &item, 0).len(), 8);
    assert_eq!(value(Windows::expert_boxes_px, &item, 0).len(), 16);
}

#[test]
fn a_twin_without_its_expert_has_no_windows() {
    let alone = DatasetItem { expert: None, ..item(Role::Perturbed) };
    assert_eq!((windows_table().rows)(&alone), 0);
    assert_eq!(value(Trajectories::difficulty, &alone, 0), None);
    assert_eq!(value(Trajectories::difficulty, &item(Role::Perturbed), 0), Some(Difficulty::Easy));
}

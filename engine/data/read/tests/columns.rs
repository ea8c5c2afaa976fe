//! Round trip of columns: the values written by an entry of the schema are read back by the same entry.

use cosfly_read::TableFile;
use cosfly_sample as sample;
use cosfly_schema::tables::{
    DatasetItem, Edges, Frames, ImageFile, Kind, Membership, Table, Trajectories, Windows, of_files, of_objects,
    of_rejections, of_trajectories,
};
use cosfly_schema::{LogRecord, PreviewStrip, Role, Split, TownLayout};
use cosfly_windows::WindowShape;
use cosfly_write::derive::derive;
use cosfly_write::table_file::TableWriter;
use std::fs::File;
use std::sync::Arc;

const WINDOWS: WindowShape = WindowShape { history: 2, horizon: 2, stride: 1 };

fn items() -> Vec<DatasetItem> {
    let expert = |record: &cosfly_schema::RenderedTrajectory| {
        record.pair.as_ref().map(|_| Box::new(sample::flight(0, Role::Expert).record))
    };
    let item = |flight: sample::SampleFlight| DatasetItem {
        derived: derive(&flight.record, &Default::default(), &WINDOWS),
        expert: expert(&flight.record),
        captions: flight.captions,
        previews: PreviewStrip { jpegs: vec![vec![1, 2, 3]; flight.record.len()] },
        log: LogRecord {
            trajectory_id: flight.record.trajectory_id.clone(),
            role: flight.record.role,
            pedestrian_id: flight.record.pedestrian_id.clone(),
            town: "plain".into(),
            frames: flight.record.len() as u64,
            messages: 70,
            bytes: 9,
            sha256: "00".into(),
        },
        mcap_path: "mcap/x.mcap".into(),
        membership: Membership {
            split: Split::Train,
            split_group: "plain/p00000".into(),
            is_seen: true,
            subset_rank: 0.5,
        },
        layout: Arc::new(TownLayout::of(&sample::town())),
        windows: WINDOWS,
        record: flight.record,
    };
    sample::flights().into_iter().map(item).collect()
}

/// Writes the records and compares every column of the file with the values of its entry.
fn check_table<S>(table: &Table<S>, records: &[S]) {
    let file = tempfile::NamedTempFile::new().unwrap();
    let mut writer = TableWriter::new(table, File::create(file.path()).unwrap()).unwrap();
    records.iter().for_each(|record| writer.append(record).unwrap());
    writer.finish().unwrap();
    let read = TableFile::open(file.path()).unwrap();
    for (place, column) in table.columns.iter().enumerate() {
        let mut found = (0..read.groups()).map(|group| read.group(group).unwrap().array(place).unwrap());
        // A table without rows has no group.
        let Some(first) = found.next() else { continue };
        let (mut array, mut at) = (first, 0);
        for record in records {
            let rows = (table.rows)(record);
            if rows == 0 {
                continue;
            }
            if at == array.len() {
                (array, at) = (found.next().unwrap(), 0);
            }
            let expected = column.array(record, rows).unwrap();
            assert_eq!(array.slice(at, rows).as_ref(), expected.as_ref(), "{}.{}", table.name, column.name());
            at += rows;
        }
    }
}

#[test]
fn every_column_reads_back_as_it_was_written() {
    let items = items();
    for mut table in of_trajectories() {
        // Row groups end between records, so that each record lies in one.
        table.rows_per_group = 1_000_000;
        check_table(&table, &items);
    }
    check_table(&of_objects(), &cosfly_schema::tables::ObjectRecord::of(&sample::town()));
    check_table(&of_rejections(), &sample::rejections());
    let files = [cosfly_schema::tables::FileRecord { path: "a".into(), bytes: 1, sha256: "00".into() }];
    check_table(&of_files(), &files);
}

#[test]
fn typed_values_of_every_kind_come_back() {
    let items = items();
    let dataset = tempfile::tempdir().unwrap();
    let written = |name: &str| {
        let table = of_trajectories().into_iter().find(|table| table.name == name).unwrap();
        let path = dataset.path().join(name);
        let mut writer = TableWriter::new(&table, File::create(&path).unwrap()).unwrap();
        items.iter().for_each(|item| writer.append(item).unwrap());
        writer.finish().unwrap();
        path
    };
    macro_rules! same {
        ($rows:expr, $row:expr, $item:expr, $place:expr, $($table:ident::$column:ident),* $(,)?) => {$(
            assert_eq!($rows.get($table::$column, $row).unwrap(), ($table::$column.cell)($item, $place));
        )*};
    }
    cosfly_read::read(&written("frames"), &mut |rows| {
        let frames = items[0].record.len();
        for row in 0..rows.len() {
            let (item, frame) = (&items[row / frames], row % frames);
            same!(rows, row, item, frame, Frames::trajectory_id, Frames::frame, Frames::drone_x_m, Frames::in_view);
            same!(rows, row, item, frame, Frames::role, Frames::visible_box_px, Frames::action_in_world);
            same!(rows, row, item, frame, Frames::term_costs, Frames::expert_frame, Frames::preview);
        }
        Ok(())
    })
    .unwrap();
    cosfly_read::read(&written("trajectories"), &mut |rows| {
        for (row, item) in items.iter().enumerate() {
            same!(rows, row, item, 0, Trajectories::synthetic_notes, Trajectories::town_layout_sketch);
            same!(rows, row, item, 0, Trajectories::mcap_bytes, Trajectories::expert_id, Trajectories::difficulty);
        }
        Ok(())
    })
    .unwrap();
    cosfly_read::read(&written("windows"), &mut |rows| {
        same!(rows, 0, &items[0], 0, Windows::input_boxes_px, Windows::caption_ids, Windows::scene);
        same!(rows, 0, &items[0], 0, Windows::instruction_en, Windows::instruction_zh);
        let refused = rows.get(cosfly_schema::tables::Column::<(), Edges>::named("turn_deg", "", |_, _| [0.0; 4]), 0);
        assert_eq!(refused.unwrap_err().code, "dataset-column");
        let absent = cosfly_schema::tables::Column::<(), ImageFile>::named("nothing", "", |_, _| ImageFile(vec![]));
        assert!(!rows.has(absent) && rows.get_or(absent, 0, ImageFile(vec![7]))? == ImageFile(vec![7]));
        Ok(())
    })
    .unwrap();
}

#[test]
fn names_are_distinct_keys_exist_and_every_column_says_what_it_is() {
    for table in of_trajectories() {
        let mut names: Vec<&str> = table.columns.iter().map(|column| column.name()).collect();
        assert!(table.key.iter().all(|key| names.contains(key)), "{}", table.name);
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{}", table.name);
        for column in &table.columns {
            let (name, doc) = (column.name(), column.doc());
            assert!(doc.ends_with('.') && doc.starts_with(char::is_uppercase), "{}.{name}: {doc}", table.name);
            let is_boxes = column.kind() == Kind::Box;
            assert!(!is_boxes || column.unit() == Some("pixels"), "{}.{name}", table.name);
        }
    }
}

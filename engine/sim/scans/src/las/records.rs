//! Records of points, taken one by one or by several threads.

use super::header::Header;
use crate::cloud::{CloudBuilder, class};
use cosfly_frames::DVec3;
use rayon::prelude::*;

/// Takes records of points.
pub(super) struct Points<'a> {
    pub(super) header: &'a Header<'a>,
    /// Length of the units of plan and height, metres.
    pub(super) units_m: [f64; 2],
    pub(super) cloud: CloudBuilder,
    pub(super) left_out: usize,
}

/// Values that the town's builder takes from the record of a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record {
    pub(super) position: [i32; 3],
    pub(super) class: u8,
    pub(super) is_kept: bool,
}

impl Record {
    /// Reads the bytes that all records of a point format begin with; there are at least 20.
    pub(super) fn read(bytes: &[u8], is_long: bool) -> Self {
        let number = |at: usize| i32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        // Formats 6 to 10 have a byte of flags and a byte for the class, older ones share one.
        const WITHHELD: [u8; 2] = [1 << 7, 1 << 2];
        const OVERLAP: u8 = 12;
        // Older formats have a class for ground that a coarse model keeps.
        const KEY_POINT: u8 = 8;
        let class = if is_long { bytes[16] } else { bytes[15] & 31 };
        let is_kept = bytes[15] & WITHHELD[usize::from(is_long)] == 0 && class != OVERLAP;
        let class = match class {
            0 => class::UNCLASSIFIED,
            KEY_POINT if !is_long => class::GROUND,
            other => other,
        };
        Self { position: [number(0), number(4), number(8)], class, is_kept }
    }
}

impl Points<'_> {
    pub(super) fn add(&mut self, record: Record) {
        if record.is_kept {
            let stored = DVec3::from_array(record.position.map(f64::from)) * self.header.scale + self.header.offset;
            let [plan_m, height_m] = self.units_m;
            self.cloud.push(stored * DVec3::new(plan_m, plan_m, height_m), record.class);
        } else {
            self.left_out += 1;
        }
    }

    /// Adds records batch by batch, as [`Self::add`] does one after another.
    pub(super) fn add_batches(&mut self, batches: Vec<Vec<Record>>) {
        let mut batches = batches.into_iter();
        // All points count from the first one that is kept.
        while self.cloud.sibling().is_none() {
            let Some(batch) = batches.next() else { return };
            batch.into_iter().for_each(|record| self.add(record));
        }
        let (header, units_m) = (self.header, self.units_m);
        let batches: Vec<(CloudBuilder, Vec<Record>)> =
            batches.filter_map(|batch| Some((self.cloud.sibling()?, batch))).collect();
        let part = |(cloud, batch): (CloudBuilder, Vec<Record>)| {
            let mut part = Points { header, units_m, cloud, left_out: 0 };
            batch.into_iter().for_each(|record| part.add(record));
            part
        };
        let parts: Vec<Points<'_>> = batches.into_par_iter().map(part).collect();
        for part in parts {
            self.cloud.join(part.cloud);
            self.left_out += part.left_out;
        }
    }

    pub(super) fn add_all(&mut self, records: &[u8]) {
        for record in records.chunks_exact(self.header.record_bytes) {
            self.add(Record::read(record, self.header.is_long()));
        }
    }
}

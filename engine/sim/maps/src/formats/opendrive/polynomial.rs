//! Piecewise cubic profiles along a road: elevation, superelevation, lane offset, widths.

/// `value(s) = a + b ds + c ds^2 + d ds^3` with `ds = s - start_s_m`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubic {
    /// Start of the record, metres along the road.
    pub start_s_m: f64,
    /// a, b, c, d.
    pub coefficients: [f64; 4],
}

impl Cubic {
    /// The value at `s`.
    pub fn value(&self, s_m: f64) -> f64 {
        let ds = s_m - self.start_s_m;
        let [a, b, c, d] = self.coefficients;
        a + ds * (b + ds * (c + ds * d))
    }

    /// The derivative at `s`.
    pub fn slope(&self, s_m: f64) -> f64 {
        let ds = s_m - self.start_s_m;
        let [_, b, c, d] = self.coefficients;
        b + ds * (2.0 * c + ds * 3.0 * d)
    }
}

/// Records in the order of their start; each holds until the next one begins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CubicProfile {
    records: Vec<Cubic>,
}

impl CubicProfile {
    /// Sorts the records by start. Of several with the same start the last one counts.
    pub fn new(mut records: Vec<Cubic>) -> Self {
        records.sort_by(|a, b| a.start_s_m.total_cmp(&b.start_s_m));
        Self { records }
    }

    /// Whether the file gave no record.
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// The records, sorted.
    pub fn records(&self) -> &[Cubic] {
        &self.records
    }

    /// The value at `s`: 0 without records; before the first one its starting value.
    pub fn value(&self, s_m: f64) -> f64 {
        self.record(s_m).map_or(0.0, |cubic| cubic.value(s_m.max(cubic.start_s_m)))
    }

    /// The derivative at `s`; 0 before the first record.
    pub fn slope(&self, s_m: f64) -> f64 {
        self.record(s_m).map_or(0.0, |cubic| if s_m < cubic.start_s_m { 0.0 } else { cubic.slope(s_m) })
    }

    fn record(&self, s_m: f64) -> Option<&Cubic> {
        let after = self.records.partition_point(|record| record.start_s_m <= s_m);
        self.records.get(after.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_record_holds_until_the_next_one_begins() {
        let profile = CubicProfile::new(vec![
            Cubic { start_s_m: 10.0, coefficients: [1.0, 2.0, 0.0, 1.0] },
            Cubic { start_s_m: 0.0, coefficients: [3.0, 0.0, 0.5, 0.0] },
        ]);
        for (s, value, slope) in
            [(-1.0, 3.0, 0.0), (0.0, 3.0, 0.0), (2.0, 5.0, 2.0), (10.0, 1.0, 2.0), (11.0, 4.0, 5.0)]
        {
            assert_eq!((profile.value(s), profile.slope(s)), (value, slope), "s = {s}");
        }
        assert_eq!(CubicProfile::default().value(3.0), 0.0);
    }
}

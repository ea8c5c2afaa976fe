//! Checks whether files can be read to their ends.

use cosfly_diagnose::Stop;
use cosfly_read::{TableFile, read_records};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Reason why a Parquet file cannot be read to its end, if any; none once `stop` is asked for.
pub fn parquet_problem(path: &Path, stop: &Stop) -> Option<String> {
    let read = || {
        let file = TableFile::open(path)?;
        for group in 0..file.groups() {
            stop.check("reading")?;
            let rows = file.group(group)?;
            (0..file.schema().fields().len()).try_for_each(|place| rows.array(place).map(drop))?;
        }
        Ok(())
    };
    let outcome: cosfly_diagnose::Result<()> = read();
    outcome
        .err()
        .filter(|_| !stop.is_asked())
        .map(|refusal| [vec![refusal.message], refusal.causes].concat().join(": "))
}

/// Reason why an MCAP file cannot be read to its end with all its checksums, if any; none once `stop` is asked for.
pub fn log_problem(path: &Path, stop: &Stop) -> Option<String> {
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) => return Some(error.to_string()),
    };
    let damage = read_records(&mut stop.reading(BufReader::new(file)), &mut |_| {}).err();
    damage.filter(|_| !stop.is_asked()).map(|damage| damage.to_string())
}

//! The table of episodes: where each is, and its own statistics, from which LeRobot makes those of parts of a dataset.

use super::statistics::{FIGURES, Figures, Statistics};
use super::tables::{self, EpisodeRow};
use arrow_array::builder::{Float64Builder, Int64Builder, ListBuilder};
use arrow_array::{ArrayRef, RecordBatch};
use arrow_schema::{Field, Schema};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::tables::schema;
use cosfly_write::table_file::BatchWriter;
use std::io::Write;
use std::sync::Arc;

/// Episodes in a row group.
const GROUP: usize = 1000;

/// The file of episodes while it is written.
pub struct EpisodeFile<W: Write + Send> {
    output: Option<W>,
    open: Option<BatchWriter<W>>,
}

impl<W: Write + Send> EpisodeFile<W> {
    /// Begins the file.
    pub fn new(output: W) -> Self {
        Self { output: Some(output), open: None }
    }

    /// Appends an episode and the statistics of its frames.
    pub fn append(&mut self, episode: &EpisodeRow, statistics: &Statistics) -> Result<()> {
        let rows = row(episode, statistics)?;
        if let Some(output) = self.output.take() {
            self.open = Some(BatchWriter::new("episodes", rows.schema(), GROUP, output)?);
        }
        self.open.as_mut().map_or(Ok(()), |writer| writer.append(&rows))
    }

    /// Ends the file.
    pub fn finish(self) -> Result<()> {
        self.open.map_or(Ok(()), BatchWriter::finish)
    }
}

fn row(episode: &EpisodeRow, statistics: &Statistics) -> Result<RecordBatch> {
    let table = tables::episodes();
    let broken = |why: &dyn std::fmt::Display| {
        Diagnostic::new("table-cell", Fault::Bug, "an episode cannot be a row of table `episodes`").because(why)
    };
    let mut fields: Vec<Field> = schema(&table).fields().iter().map(|field| field.as_ref().clone()).collect();
    let own = table.columns.iter().map(|column| column.array(episode, 1));
    let mut columns: Vec<ArrayRef> =
        own.collect::<std::result::Result<_, _>>().map_err(|problem| broken(&problem.rule))?;
    for (feature, figures) in statistics.features() {
        for (at, figure) in FIGURES.iter().enumerate() {
            let numbers = figures.numbers.iter().map(|number| number[at]);
            columns.push(if figures.is_picture { of_channels(numbers) } else { of_numbers(numbers) });
            fields.push(Field::new(
                format!("stats/{feature}/{figure}"),
                columns[columns.len() - 1].data_type().clone(),
                true,
            ));
        }
        columns.push(count(&figures));
        fields.push(Field::new(format!("stats/{feature}/count"), columns[columns.len() - 1].data_type().clone(), true));
    }
    RecordBatch::try_new(Arc::new(Schema::new(fields)), columns).map_err(|error| broken(&error))
}

fn count(figures: &Figures) -> ArrayRef {
    let mut list = ListBuilder::new(Int64Builder::new());
    list.values().append_value(i64::try_from(figures.count).unwrap_or(i64::MAX));
    list.append(true);
    Arc::new(list.finish())
}

/// A row with a number for each part of a vector.
fn of_numbers(numbers: impl Iterator<Item = f64>) -> ArrayRef {
    let mut list = ListBuilder::new(Float64Builder::new());
    numbers.for_each(|number| list.values().append_value(number));
    list.append(true);
    Arc::new(list.finish())
}

/// A row with a number for each channel, of the shape (channels, 1, 1).
fn of_channels(numbers: impl Iterator<Item = f64>) -> ArrayRef {
    let mut list = ListBuilder::new(ListBuilder::new(ListBuilder::new(Float64Builder::new())));
    for number in numbers {
        list.values().values().values().append_value(number);
        list.values().values().append(true);
        list.values().append(true);
    }
    list.append(true);
    Arc::new(list.finish())
}

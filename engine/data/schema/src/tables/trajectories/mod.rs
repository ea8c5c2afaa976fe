//! Table `trajectories`: one row per trajectory, with its certificate, weather, camera and log.

mod camera;
mod certificate;
mod columns;
mod identity;
mod log;
mod optics;
mod target;
mod weather;

pub use columns::Trajectories;
pub use weather::{WEATHER_NUMBERS, WeatherNumber};

use super::{AnyColumn, DatasetItem, Need, Table};

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "One row per trajectory: town, weather, camera, certificate, costs, and where its log is.";
    let weather = WEATHER_NUMBERS.iter().map(|number| &number.column as &dyn AnyColumn<DatasetItem>);
    let mut columns = Trajectories::IDENTITY.to_vec();
    columns.extend(Trajectories::WEATHER.iter().copied().chain(weather));
    let [camera, optics, target] = [Trajectories::CAMERA, Trajectories::OPTICS, Trajectories::TARGET];
    columns.extend([camera, optics, target, Trajectories::CERTIFICATE, Trajectories::LOG].into_iter().flatten());
    let (rows_per_group, needs) = (10_000, &[Need::Expert][..]);
    let table = Table::new("trajectories", doc, &["trajectory_id"], |_: &DatasetItem| 1, &[]);
    Table { rows_per_group, needs, columns, ..table }
}

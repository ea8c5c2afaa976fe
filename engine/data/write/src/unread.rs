//! Sensors of a rig that read along the films of one camera alone.

use cosfly_schema::RenderedTrajectory;
use cosfly_schema::extras::ExtraSource;
use cosfly_schema::flight_table::{ColumnKind, Values};

/// The values of a film that a sensor with this key `camera` does not read: none in each column; `None` of a film that it reads.
pub fn unread(record: &RenderedTrajectory, camera: Option<&str>, source: &ExtraSource) -> Option<Vec<Values>> {
    let is_read = camera.is_none_or(|camera| record.camera_name.as_deref() == Some(camera));
    let empty = |kind: ColumnKind| match kind {
        ColumnKind::Real => Values::Reals(vec![]),
        ColumnKind::Integer => Values::Integers(vec![]),
        ColumnKind::Boolean => Values::Booleans(vec![]),
        ColumnKind::Text => Values::Texts(vec![]),
        ColumnKind::Bytes => Values::Bytes(vec![]),
    };
    (!is_read).then(|| source.columns.iter().map(|column| empty(column.kind)).collect())
}

//! Flights against the triangles of a scan: distances of an own measure, apart from the planner's boxes and from the renderer.

use super::flights::Flights;
use super::report::VerifyReport;
use super::rows::PlacedFlight;
use cosfly_diagnose::Result;
use cosfly_frames::DVec3;
use cosfly_metrics::scanned_mesh::ScannedMesh;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Flights whose rows are read at a time.
const TOGETHER: usize = 64;
/// Distances are good to this much, metres: corners are 32-bit numbers.
const ROUNDING_M: f64 = 0.01;

/// Flights whose certificate holds keep its clearance from every triangle, the ground's among them.
pub fn check(flights: &Flights<'_>, mesh: Option<&ScannedMesh>, report: &mut VerifyReport) -> Result<()> {
    let Some(mesh) = mesh else { return Ok(()) };
    let list = &flights.tables.flights;
    let limit_m = |flight: &PlacedFlight| flight.limits[0].filter(|_| flight.figures.holds && flight.town == mesh.town);
    let compared = |number: &usize| flights.wanted.has(*number) && limit_m(list.at(*number)).is_some();
    let numbers: Vec<usize> = (0..list.len()).filter(compared).collect();
    for together in numbers.chunks(TOGETHER) {
        flights.files.stop.check("verify")?;
        let tracks = flights.tracks(&together.iter().copied().collect::<BTreeSet<_>>());
        let near: Vec<_> = tracks
            .par_iter()
            .map(|(number, track)| {
                let path: Vec<DVec3> = track.poses.iter().map(|pose| pose.position_in_world).collect();
                let limit_m = limit_m(list.at(*number)).unwrap_or_default();
                (*number, limit_m, mesh.nearest(&path, limit_m - ROUNDING_M))
            })
            .collect();
        report.meshed += near.len() as u64;
        for (number, limit_m, found) in near {
            let Some((frame, away_m)) = found else { continue };
            let flight = list.at(number);
            let place = format!("row {}, `{}` frame {frame}", flight.place.1, flight.trajectory_id);
            let message =
                format!("the flight comes within {away_m:.2} m of the mesh; its certificate keeps {limit_m} m");
            report.find(&flight.place.0, place, "verify-mesh", message);
        }
    }
    Ok(())
}

//! Sensor `barometer`: the pressure of the air.

use crate::drift::Drift;
use crate::sensor::{Carrier, Quantity, Sensor, SensorMoment};
use cosfly_frames::real;

/// Drift by weather and temperature: 0.06 hPa is half a metre.
const DRIFT: Drift = Drift { deviation: 0.06, time_constant_s: 300.0 };
/// White noise of a reading, hPa: that of the MS5611 at its finest, 0.012 mbar.
const NOISE_HPA: f64 = 0.012;

/// Air of the standard atmosphere, 1013.25 hPa at height 0 of the world frame.
pub static SENSOR: Sensor = Sensor {
    name: "barometer",
    doc: "Pressure of the standard atmosphere, 1013.25 hPa at height 0 of the world, with white noise of 0.012 hPa a reading (the class \
          of the MS5611) and a drift of 0.06 hPa.",
    version: 1,
    carrier: Carrier::Airframe,
    quantities: &[
        Quantity { name: "pressure_hpa", doc: "pressure of the air, hPa" },
        Quantity { name: "altitude_m", doc: "height with this pressure in the standard atmosphere, metres" },
    ],
    truths: &[
        Quantity { name: "true_pressure_hpa", doc: "`pressure_hpa` without errors" },
        Quantity { name: "true_altitude_m", doc: "height of the sensor above height 0 of the world, metres" },
    ],
    read,
};

fn read(at: &SensorMoment<'_>, values: &mut [f64]) {
    let height_m = at.airframe.position_in_world.z;
    let exact_hpa = 1013.25 * real::powf(1.0 - height_m / 44_330.77, 5.255_88);
    let [drift_hpa] = DRIFT.at(&at.flight_seed, "barometer", at.time_s);
    let pressure_hpa = exact_hpa + drift_hpa + at.seed.stream("barometer").normal(0.0, NOISE_HPA);
    let altitude_m = 44_330.77 * (1.0 - real::powf(pressure_hpa / 1013.25, 1.0 / 5.255_88));
    values.copy_from_slice(&[pressure_hpa, altitude_m, exact_hpa, height_m]);
}

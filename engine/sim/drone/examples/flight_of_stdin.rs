//! For comparisons with programs of others: `quadrotor` flies commands from standard input, `gusts` and `inertial` print samples.
//!
//! `quadrotor`: the first line is a state (position 3, attitude xyzw 4, velocity 3, body rates 3, rotors 4), every other line four
//! speeds, three components of the wind and a step; prints the state after each. The right-handed frame, SI, rev/min.
//! `gusts STEP SPEED DEVIATION LENGTH COUNT` and `inertial RATE COUNT` print three and six numbers a line.

use cosfly_drone::models::quadrotor;
use cosfly_drone::quadrotor::{Gyroscope, Quadrotor, QuadrotorParameters, QuadrotorState};
use cosfly_drone::sensors::{Carried, InertialParameters, InertialUnit};
use cosfly_drone::wind::{Gusts, Turbulence};
use cosfly_frames::{DQuat, DVec3, Seed};
use std::io::{BufRead, Write};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize| arguments[at].parse::<f64>().expect("a number");
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    let mut tell = |numbers: &[f64]| {
        let words: Vec<String> = numbers.iter().map(|number| format!("{number:e}")).collect();
        writeln!(out, "{}", words.join(" ")).expect("printed");
    };
    match arguments[0].as_str() {
        "quadrotor" => {
            let parameters =
                QuadrotorParameters { gyroscope: Gyroscope::OfDroneModels, ..quadrotor("crazyflie").unwrap() };
            let mut drone = Quadrotor::hovering(DVec3::ZERO, parameters);
            for (at, line) in std::io::stdin().lock().lines().enumerate() {
                let line = line.expect("read");
                let n: Vec<f64> = line.split_whitespace().map(|word| word.parse().expect("a number")).collect();
                let vector = |from: usize| DVec3::new(n[from], n[from + 1], n[from + 2]);
                if at == 0 {
                    drone.state = QuadrotorState {
                        position_m: vector(0),
                        attitude: DQuat::from_xyzw(n[3], n[4], n[5], n[6]),
                        velocity_mps: vector(7),
                        rates_rad_s: vector(10),
                        rotors_rpm: [n[13], n[14], n[15], n[16]],
                    };
                    continue;
                }
                drone.step([n[0], n[1], n[2], n[3]], vector(4), n[7]);
                let state = &drone.state;
                let mut numbers = state.position_m.to_array().to_vec();
                numbers.extend(state.attitude.to_array());
                numbers.extend(state.velocity_mps.to_array());
                numbers.extend(state.rates_rad_s.to_array());
                numbers.extend(state.rotors_rpm);
                tell(&numbers);
            }
        }
        "gusts" => {
            let turbulence = Turbulence { deviation_mps: DVec3::splat(number(3)), length_m: DVec3::splat(number(4)) };
            let mut gusts = Gusts::new(&turbulence, number(2), number(1), Seed([9; 32]));
            (0..number(5) as usize).for_each(|_| tell(&gusts.next_mps().to_array()));
        }
        "inertial" => {
            let parameters = InertialParameters { rate_hz: number(1), ..InertialParameters::adis16448() };
            let mut unit = InertialUnit::new(parameters, Seed([9; 32]));
            let still = Carried { attitude: DQuat::IDENTITY, velocity_mps: DVec3::ZERO };
            for _ in 0..number(2) as usize {
                let sample = unit.sample(&still, &still);
                let [[a, b, c], [d, e, f]] = [sample.rates_rad_s, sample.force_mps2].map(|it| it.to_array());
                tell(&[a, b, c, d, e, f]);
            }
        }
        other => panic!("`{other}` is none of quadrotor, gusts, inertial"),
    }
}

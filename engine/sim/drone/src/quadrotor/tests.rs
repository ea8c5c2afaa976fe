//! Quadrotors: hover, free fall, drag, a controller that reaches setpoints in wind, steps that converge.

use super::{ControlGains, Controller, Quadrotor, QuadrotorParameters, Setpoint};
use crate::models::quadrotor;
use cosfly_frames::{DQuat, DVec3};

fn both() -> [QuadrotorParameters; 2] {
    [quadrotor("crazyflie").unwrap(), quadrotor("pelican").unwrap()]
}

#[test]
fn rotors_at_hover_carry_the_weight() {
    for parameters in both() {
        let hover = [parameters.hover_rpm(); 4];
        let mut drone = Quadrotor::hovering(DVec3::Z, parameters);
        (0..1000).for_each(|_| drone.step(hover, DVec3::ZERO, 0.002));
        assert!((drone.state.position_m - DVec3::Z).length() < 1e-6, "{:?}", drone.state);
    }
}

#[test]
fn each_axis_turns_the_way_the_rotors_say() {
    for parameters in both() {
        for axis in 0..3 {
            let signs = parameters.mixing[axis];
            let hover = parameters.hover_rpm();
            let mut drone = Quadrotor::hovering(DVec3::ZERO, parameters.clone());
            (0..50).for_each(|_| drone.step(signs.map(|sign| hover * (1.0 + 0.01 * sign)), DVec3::ZERO, 0.001));
            let rates = drone.state.rates_rad_s.to_array();
            assert!(rates[axis] > 1e-3, "{axis} {rates:?}");
            assert!((0..3).all(|other| other == axis || rates[other].abs() < 0.1 * rates[axis]), "{axis} {rates:?}");
        }
    }
}

#[test]
fn smaller_steps_converge_with_the_fourth_order() {
    let flown = |steps: u32| {
        let mut drone = Quadrotor::hovering(DVec3::ZERO, quadrotor("pelican").unwrap());
        drone.state.rates_rad_s = DVec3::new(1.0, -2.0, 0.5);
        drone.state.velocity_mps = DVec3::new(5.0, 1.0, -1.0);
        let hover = drone.parameters.hover_rpm();
        let command = [1.1 * hover, 1.05 * hover, 1.12 * hover, 1.07 * hover];
        (0..steps).for_each(|_| drone.step(command, DVec3::ZERO, 0.4 / f64::from(steps)));
        drone.state.position_m
    };
    let exact = flown(3200);
    let [coarse, fine] = [100, 200].map(|steps| (flown(steps) - exact).length());
    assert!(coarse / fine > 12.0 && fine < 1e-7, "{coarse} {fine}");
}

#[test]
fn a_controller_reaches_a_setpoint_and_stays_near_it_in_wind() {
    for parameters in both() {
        let controller = Controller::new(&parameters, ControlGains::default());
        let setpoint = Setpoint { position_m: DVec3::new(3.0, -2.0, 1.5), yaw_rad: 1.2, ..Setpoint::default() };
        for (wind, within_m) in [(DVec3::ZERO, 1e-3), (DVec3::new(2.0, 1.0, 0.0), 0.5)] {
            let mut drone = Quadrotor::hovering(DVec3::ZERO, parameters.clone());
            for _ in 0..4000 {
                let wanted = controller.track(&drone.state, &setpoint);
                let rotors = controller.rotors_rpm(&drone.state, &wanted);
                drone.step(rotors, wind, 0.002);
            }
            let away_m = (drone.state.position_m - setpoint.position_m).length();
            let ahead = drone.state.attitude * DVec3::X;
            assert!(away_m < within_m, "{away_m} m in wind {wind}");
            assert!((ahead.truncate().normalize().dot(glam::DVec2::from_angle(1.2)) - 1.0).abs() < 1e-3);
        }
    }
}

#[test]
fn frames_flip_and_flip_back() {
    let vector = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(super::flipped(super::flipped(vector)), vector);
    let tilted = Quadrotor::hovering(DVec3::ZERO, quadrotor("pelican").unwrap());
    let state = super::QuadrotorState { attitude: DQuat::from_rotation_y(0.2), ..tilted.state };
    let slope = tilted.derivative(&state, state.rotors_rpm, DVec3::ZERO);
    assert!(slope.acceleration_mps2.x > 0.0 && slope.acceleration_mps2.z < 0.0, "nose down flies ahead");
}

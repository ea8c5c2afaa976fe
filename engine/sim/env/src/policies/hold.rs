//! `hold`: stops and looks where it looked.

use super::{Baseline, Policy};
use crate::{Action, Environment};

pub(super) const BASELINE: Baseline =
    Baseline { name: "hold", doc: "stops and looks where it looked", sees: &["state"], make: |_, _| Box::new(Hold) };

struct Hold;

impl Policy for Hold {
    fn act(&mut self, _: &Environment) -> Action {
        Action::default()
    }
}

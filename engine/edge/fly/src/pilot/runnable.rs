//! [`Runnable`]: a policy that may be run again from what others sent.

use super::baseline::BaselinePilot;
use super::onnx::{OnnxPilot, OnnxPolicy};
use super::place::Place;
use super::seam::Pilot;
use crate::results::PolicyCard;
use cosfly_env::policies::{Variation, baseline};

/// A policy that may be run again from what others sent: a baseline of this program, or a network in ONNX, which the interpreter keeps
/// within its bounds. Servers and functions in Python are programs of others, which are never run from a bundle.
#[derive(Clone, Debug, PartialEq)]
pub enum Runnable {
    /// A baseline, with changes.
    Baseline(&'static str, Variation),
    /// A network.
    Onnx(OnnxPolicy),
}

impl Runnable {
    /// The policy of a card, whose file is `onnx` where it is a network; none where there is nothing to run.
    ///
    /// # Errors
    /// Why the policy is not the one of the card, in words.
    pub fn of(card: &PolicyCard, onnx: Option<&[u8]>) -> Result<Option<Self>, String> {
        if let Some(name) = &card.baseline {
            let own = PolicyCard::of_baseline(name.clone(), &card.name, card.version.clone());
            if *card != (PolicyCard { sensors: card.sensors.clone(), ..own }) {
                return Err("its card names a baseline and says other things of its policy".to_owned());
            }
            return match Place::of_baseline(name) {
                Some(Place::Baseline { name, variation }) => Ok(Some(Self::Baseline(name, variation))),
                _ => Err(format!("there is no baseline `{name}`")),
            };
        }
        let Some(bytes) = onnx.filter(|_| card.kind == "onnx") else { return Ok(None) };
        let policy = OnnxPolicy::of_bytes(&card.name, bytes.to_vec())
            .map_err(|rule| format!("the file of its policy is no network that cosfly flies: {rule}"))?;
        let own = PolicyCard::of_onnx(&policy, &card.name, card.version.clone());
        if card.source != own.source {
            let (theirs, source) = (policy.digest(), card.source.as_deref().unwrap_or("none"));
            return Err(format!("the file of its policy has the digest {theirs}, its card has {source}"));
        }
        match own == *card {
            true => Ok(Some(Self::Onnx(policy))),
            false => Err("its card says another thing of the policy than the policy's own file".to_owned()),
        }
    }

    /// Its inputs.
    pub fn sees(&self) -> Vec<&'static str> {
        match self {
            Self::Onnx(policy) => policy.sees(),
            Self::Baseline(name, _) => baseline(name).map_or_else(Vec::new, |baseline| baseline.sees.to_vec()),
        }
    }

    /// The policy, for one thread.
    pub fn pilot(&self) -> Box<dyn Pilot> {
        match self {
            Self::Onnx(policy) => Box::new(OnnxPilot::new(policy)),
            Self::Baseline(name, variation) => Box::new(BaselinePilot::new(name, *variation)),
        }
    }
}

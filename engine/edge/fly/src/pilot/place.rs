//! [`Place`]: where a policy is.

use super::onnx::OnnxPolicy;
use cosfly_diagnose::{Diagnostic, Fault, Result, nearest_name};
use cosfly_env::policies::{BASELINES, Variation};
use cosfly_secrets::{has_secret, without_secrets};
use std::path::Path;

/// Where a policy is.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// One of [`BASELINES`].
    Baseline {
        /// Name.
        name: &'static str,
        /// Changes to its actions.
        variation: Variation,
    },
    /// `onnx:FILE`, a network with a description.
    Onnx(OnnxPolicy),
    /// `ws://HOST:PORT`, a server that speaks openpi's wire.
    Socket(String),
    /// `python:module:function`.
    Python {
        /// Module.
        module: String,
        /// Function of the module: takes an observation, gives an action.
        function: String,
    },
}

impl Place {
    /// Reads `ws://HOST:PORT`, `python:module:function`, `onnx:FILE` (and the file), or the name of a baseline and changes to it: `follow:gain=0.5`.
    ///
    /// # Errors
    /// `fly-policy`, with what is allowed; those of [`OnnxPolicy::read`].
    pub fn read(text: &str) -> Result<Self> {
        let refused = |message: String| Diagnostic::new("fly-policy", Fault::Recipe, message);
        // The address names folders and stands on cards and pages.
        if has_secret(text) {
            let message = format!("`{}` holds a name, a password or a key", without_secrets(text));
            return Err(refused(message).hint(
                "give the key of a server in the environment variable COSFLY_API_KEY or in a file with `--api-key-file`; it is written nowhere",
            ));
        }
        if text.starts_with("ws://") {
            return Ok(Self::Socket(text.to_owned()));
        }
        if text.starts_with("wss://") {
            let message = format!("`{text}` asks for an encrypted connection, which `cosfly fly` does not make");
            return Err(refused(message).hint("use ws://, through a tunnel such as `ssh -L` where the network is open"));
        }
        if let Some(file) = text.strip_prefix("onnx:") {
            return OnnxPolicy::read(Path::new(file)).map(Self::Onnx);
        }
        if let Some(rest) = text.strip_prefix("python:") {
            let parts: Vec<&str> = rest.split(':').collect();
            return match parts[..] {
                [module, function] if !module.is_empty() && !function.is_empty() => {
                    Ok(Self::Python { module: module.to_owned(), function: function.to_owned() })
                }
                _ => Err(refused(format!("`{text}` must be `python:MODULE:FUNCTION`"))),
            };
        }
        let names = || BASELINES.iter().map(|it| it.name);
        let (asked, change) = text.split_once(':').map_or((text, None), |(name, change)| (name, Some(change)));
        if let Some(baseline) = BASELINES.iter().find(|it| it.name == asked) {
            let variation = change.map_or(Ok(Variation::NONE), Variation::read).map_err(refused)?;
            return Ok(Self::Baseline { name: baseline.name, variation });
        }
        let problem = refused(format!("there is no policy `{text}`"));
        let problem = match (nearest_name(asked, names()), change) {
            (Some(near), _) => problem.hint(format!("did you mean `{near}`?")),
            (None, None) if text.ends_with(".onnx") => problem.hint(format!("did you mean `onnx:{text}`?")),
            (None, Some(port)) if port.parse::<u16>().is_ok() => problem.hint(format!("did you mean `ws://{text}`?")),
            (None, Some(_)) if !text.contains('/') => problem.hint(format!("did you mean `python:{text}`?")),
            (None, _) => problem,
        };
        let names: Vec<&str> = names().collect();
        Err(problem
            .hint(format!("allowed are ws://HOST:PORT, python:MODULE:FUNCTION, onnx:FILE, {}", names.join(", "))))
    }

    /// The baseline whose [`Self::name`] this is.
    pub fn of_baseline(name: &str) -> Option<Self> {
        BASELINES.iter().find_map(|baseline| {
            let change = name.strip_prefix(baseline.name)?;
            let variation = match change.strip_prefix("-gain") {
                None if change.is_empty() => Variation::NONE,
                None => return None,
                Some(change) => {
                    let change = change.replacen("-delay", ",delay_s=", 1).replacen("-noise", ",noise_mps=", 1);
                    let change = change.replacen("-lead", ",lead_s=", 1);
                    Variation::read(&format!("gain={change}")).ok()?
                }
            };
            let place = Self::Baseline { name: baseline.name, variation };
            (place.name() == name).then_some(place)
        })
    }

    /// Name in tables and of folders, where none is given.
    pub fn name(&self) -> String {
        let safe = |text: &str| {
            let kept = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' };
            text.chars().map(kept).collect::<String>()
        };
        match self {
            Self::Baseline { name, variation } if *variation == Variation::NONE => (*name).to_owned(),
            Self::Baseline { name, variation: Variation { delay_s, gain, lead_s, noise_mps } } => {
                let lead = if *lead_s > 0.0 { format!("-lead{lead_s}") } else { String::new() };
                format!("{name}-gain{gain}-delay{delay_s}-noise{noise_mps}{lead}")
            }
            Self::Onnx(policy) => safe(policy.name()),
            Self::Socket(address) => safe(address.trim_start_matches("ws://")),
            Self::Python { module, function } => safe(&format!("{module}.{function}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_without_its_kind_is_told_with_it() {
        for (text, meant) in [
            ("mine:act", "`python:mine:act`"),
            ("localhost:8000", "`ws://localhost:8000`"),
            ("nets/mine.onnx", "`onnx:nets/mine.onnx`"),
            ("folow", "`follow`"),
        ] {
            let refused = Place::read(text).expect_err("refused");
            assert!(refused.hints[0].contains(meant), "{text}: {:?}", refused.hints);
        }
    }

    #[test]
    fn names_of_baselines_are_read_back() {
        for text in
            ["hold", "constant-velocity", "follow:gain=0.5", "causal:delay_s=0.3,noise_mps=1", "follow:lead_s=0.4"]
        {
            let place = Place::read(text).expect("a baseline");
            assert_eq!(Place::of_baseline(&place.name()), Some(place), "{text}");
        }
        for wrong in ["", "holds", "follow-gain0.5", "follow-gain99-delay0-noise0", "127.0.0.1-8000"] {
            assert_eq!(Place::of_baseline(wrong), None, "{wrong}");
        }
    }
}

//! Connections between stages: checks of names, ports and artifacts.

use crate::document::{Place, Problems, Texts, list};
use crate::kinds::{KnownStage, kinds_that_make};
use crate::order::Reads;
use crate::outline::{InputOutline, Outline, StageOutline};
use cosfly_diagnose::{Diagnostic, nearest_name};
use cosfly_stage::{InputPort, Registry, Takes};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Connected stages by stage of the outline and port, in the order of the recipe.
pub(crate) type Wires = Vec<BTreeMap<String, Vec<(usize, Place)>>>;

/// Connections as written in the recipe.
pub(crate) struct Wiring<'a> {
    outline: &'a Outline,
    known: &'a [Option<KnownStage>],
    registry: &'a Registry,
    texts: &'a Texts,
    /// Numbers of the stages of the outline.
    positions: BTreeMap<&'a str, usize>,
    /// Kinds that make an artifact, by artifact; cached, because building all kinds takes long.
    makers: RefCell<BTreeMap<&'static str, Vec<&'static str>>>,
}

/// Existing connections of the graph.
pub(crate) struct Connected {
    pub(crate) wires: Wires,
    pub(crate) reads: Reads,
    /// Errors of connections whose upstream stage makes another artifact.
    pub(crate) mismatches: Problems,
}

impl<'a> Wiring<'a> {
    pub(crate) fn new(
        outline: &'a Outline,
        known: &'a [Option<KnownStage>],
        registry: &'a Registry,
        texts: &'a Texts,
    ) -> Self {
        let names = outline.stages.iter().enumerate();
        let positions = names.map(|(index, stage)| (stage.name.as_str(), index)).collect();
        Self { outline, known, registry, texts, positions, makers: RefCell::default() }
    }

    /// Checks every connection: returns the existing ones, and reports errors.
    pub(crate) fn connect(&self, problems: &mut Problems) -> Connected {
        let (mut wires, mut reads, mut mismatches) = (vec![], vec![], vec![]);
        for (stage, known) in self.outline.stages.iter().zip(self.known) {
            let mut ports = BTreeMap::new();
            for input in &stage.inputs {
                let upstreams = self.upstreams(stage, input, problems);
                if let Some(known) = known {
                    self.check_port(stage, input, &known.ports, &upstreams, problems);
                    mismatches.extend(self.mismatches(stage, input, &known.ports, &upstreams));
                }
                ports.insert(input.port.clone(), upstreams);
            }
            if let Some(known) = known {
                let mistyped = self.mistyped_ports(stage, &known.ports);
                let missing = known
                    .ports
                    .iter()
                    .filter(|port| !port.optional && !ports.contains_key(port.name) && !mistyped.contains(&port.name));
                problems.extend(missing.map(|port| self.missing_input(stage, port)));
            }
            reads.push(ports.values().flatten().cloned().collect());
            wires.push(ports);
        }
        Connected { wires, reads, mismatches }
    }

    fn upstreams(&self, stage: &StageOutline, input: &InputOutline, problems: &mut Problems) -> Vec<(usize, Place)> {
        let mut upstreams: Vec<(usize, Place)> = vec![];
        for (name, place) in &input.stages {
            match self.positions.get(name.as_str()).copied() {
                None => problems.push(self.unknown_stage(stage, name, place)),
                Some(index) if upstreams.iter().any(|(known, _)| *known == index) => {
                    let message = format!("`{name}` is connected twice to `inputs.{}` of `{}`", input.port, stage.name);
                    problems.push(self.texts.problem("recipe-input-twice", place, message).hint("name it once"));
                }
                Some(index) => upstreams.push((index, place.clone())),
            }
        }
        upstreams
    }

    fn unknown_stage(&self, stage: &StageOutline, name: &str, place: &Place) -> Box<Diagnostic> {
        let known = || {
            self.outline.stages.iter().map(|stage| stage.name.as_str()).filter(|known| *known != stage.name.as_str())
        };
        let message = format!("`{}` reads `{name}`, but the recipe has no such stage", stage.name);
        let problem = self.texts.problem("recipe-unknown-stage", place, message);
        let problem = match nearest_name(name, known()) {
            Some(near) => problem.hint(format!("did you mean `{near}`?")),
            None => problem,
        };
        match known().next() {
            Some(_) => problem.hint(format!("other stages of the recipe: {}", list(known(), 40))),
            None => problem.hint("the recipe has no other stage"),
        }
    }

    fn check_port(
        &self,
        stage: &StageOutline,
        input: &InputOutline,
        ports: &[InputPort],
        upstreams: &[(usize, Place)],
        problems: &mut Problems,
    ) {
        let kind = stage.kind.as_ref().map_or("", |(kind, _)| kind);
        let Some(port) = ports.iter().find(|port| port.name == input.port) else {
            let message = format!("`{}` is not an input of `{kind}`", input.port);
            let problem = self.texts.problem("recipe-unknown-port", &input.place, message);
            if let Some(now) = self.name_of_today(stage, &input.port) {
                problems.push(problem.hint(format!("the input is called `{now}` now")));
                return;
            }
            let problem = match nearest_name(&input.port, ports.iter().map(|port| port.name)) {
                Some(near) => problem.hint(format!("did you mean `{near}`?")),
                None => problem,
            };
            problems.push(match ports {
                [] => problem.hint(format!("`{kind}` has no inputs")),
                _ => problem.hint(format!("inputs of `{kind}`: {}", list(ports.iter().map(|port| port.name), 40))),
            });
            return;
        };
        if let [_, (second, place), ..] = upstreams
            && port.takes == Takes::One
        {
            let second = &self.outline.stages[*second].name;
            let message =
                format!("`inputs.{}` of `{}` takes one stage, and `{second}` is a second one", port.name, stage.name);
            problems.push(self.texts.problem("recipe-input-twice", place, message).hint("connect one of them"));
        }
        if input.listed && input.stages.is_empty() && !port.optional {
            let message = format!("`inputs.{}` of `{}` does not name a stage", port.name, stage.name);
            let problem = self.texts.problem("recipe-missing-input", &input.place, message);
            problems.push(self.connectable(problem, stage, port));
        }
    }

    /// Errors of connections whose upstream stage makes another artifact than the port takes.
    fn mismatches(
        &self,
        stage: &StageOutline,
        input: &InputOutline,
        ports: &[InputPort],
        upstreams: &[(usize, Place)],
    ) -> Problems {
        let Some(port) = ports.iter().find(|port| port.name == input.port) else { return vec![] };
        let mut found = vec![];
        for (upstream, place) in upstreams {
            let made = self.known[*upstream].as_ref().and_then(|known| known.built.as_ref()?.artifact());
            if let Some(made) = made.filter(|made| *made != port.artifact) {
                let name = &self.outline.stages[*upstream].name;
                let message = format!(
                    "`inputs.{}` of `{}` takes `{}`, but `{name}` makes `{made}`",
                    port.name, stage.name, port.artifact
                );
                let problem = self.texts.problem("recipe-artifact-mismatch", place, message);
                found.push(self.connectable(problem, stage, port));
            }
        }
        found
    }

    fn missing_input(&self, stage: &StageOutline, port: &InputPort) -> Box<Diagnostic> {
        let message =
            format!("`{}` needs `inputs.{}` ({}, `{}`)", stage.name, port.name, sentence(port), port.artifact);
        let problem = self.texts.problem("recipe-missing-input", &stage.place, message);
        self.connectable(problem, stage, port)
    }

    /// Adds hints with the stages of this recipe and the kinds that make the artifact of `port`.
    fn connectable(&self, problem: Box<Diagnostic>, reader: &StageOutline, port: &InputPort) -> Box<Diagnostic> {
        let makers: Vec<&str> = self
            .outline
            .stages
            .iter()
            .zip(self.known)
            .filter(|(stage, known)| {
                let artifact = known.as_ref().and_then(|known| known.built.as_ref()?.artifact());
                stage.name != reader.name && artifact == Some(port.artifact)
            })
            .map(|(stage, _)| stage.name.as_str())
            .collect();
        let mut makers_by_kind = self.makers.borrow_mut();
        let kinds =
            makers_by_kind.entry(port.artifact).or_insert_with(|| kinds_that_make(self.registry, port.artifact));
        let problem = match &makers[..] {
            [] => problem,
            [one] => problem.hint(format!("write `inputs.{} = \"{one}\"` in `[stages.{}]`", port.name, reader.name)),
            _ => problem.hint(format!("`{}` is made by {}", port.artifact, list(makers.iter().copied(), 20))),
        };
        match &kinds[..] {
            [] => problem,
            _ => problem.hint(format!("stage kinds that make `{}`: {}", port.artifact, list(kinds.iter(), 20))),
        }
    }

    /// The name that a former port of a stage's kind has today.
    fn name_of_today(&self, stage: &StageOutline, port: &str) -> Option<&'static str> {
        let (kind, _) = stage.kind.as_ref()?;
        let gone = self.registry.get(kind)?.gone();
        gone.iter().find(|(former, _)| *former == port).map(|(_, now)| *now)
    }

    /// Ports that an unknown name was probably meant to be: they are not reported as missing as well.
    fn mistyped_ports(&self, stage: &StageOutline, ports: &[InputPort]) -> Vec<&'static str> {
        let names = || ports.iter().map(|port| port.name);
        let unknown = stage.inputs.iter().filter(|input| names().all(|name| name != input.port));
        unknown
            .filter_map(|it| self.name_of_today(stage, &it.port).or_else(|| nearest_name(&it.port, names())))
            .collect()
    }
}

fn sentence(port: &InputPort) -> &str {
    port.doc.trim_end_matches('.')
}

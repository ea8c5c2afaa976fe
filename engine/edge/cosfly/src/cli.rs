//! The whole command line: its help, examples and exit codes.

use crate::command::with_commands;
use crate::commands::COMMANDS;

const LONG_ABOUT: &str = "\
Datasets that teach drones to follow a moving target without losing sight of it.

A recipe (one TOML file) describes a town, pedestrians, an expert drone pilot, pictures, captions and a dataset; \
`cosfly run` makes it, item by item, and never computes the same item twice.";

const AFTER_HELP: &str = "\
Examples:
  cosfly run recipes/carla_town.toml               make the dataset in out/carla_town
  cosfly plan recipes/carla_town.toml              what would run, and why
  cosfly run recipes/carla_town.toml --set stages.walkers.count=20
  cosfly why recipes/carla_town.toml expert/p00003 what changed since this was last made
  cosfly verify out/carla_town                     check a finished dataset
  cosfly preview out/carla_town                    pictures of a finished flight
  cosfly eval out/carla_town mine.jsonl            scores of a model's predictions, beside baselines
  cosfly export out/carla_town --format v7 --out out/town-v7

Exit codes:
    0  the command succeeded
    1  the command found problems; the help of the command says which
    2  the command line is invalid
    3  the recipe or the command line asks for something impossible
    4  an input file, the store or a given state is missing, unreadable, broken or does not fit
    5  system error: disk full, no permission, a file vanished
   70  internal error: please report it
  130  stopped by Ctrl-C; finished items are kept

Environment:
  COSFLY_STORE    place of the store, where `--store` is not given
  COSFLY_CACHE    folder for caches of stores in buckets [default: the folder for temporary files]
  COSFLY_HQ       the command of HyperQueue [default: `hq` on the PATH]
  COSFLY_API_KEY  key of a policy's server, where `--api-key-file` is not given
  COSFLY_SIMD     plain, avx2 or avx512 [default: the best of the processor]; all give the same bytes
  NO_COLOR        no colours";

/// The whole command line.
pub fn cli() -> clap::Command {
    let cosfly = clap::Command::new("cosfly")
        .version(env!("CARGO_PKG_VERSION"))
        .about(env!("CARGO_PKG_DESCRIPTION"))
        .long_about(LONG_ABOUT)
        .after_long_help(AFTER_HELP)
        .max_term_width(100);
    with_commands(cosfly, COMMANDS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exit;

    #[test]
    fn the_help_names_every_exit_code() {
        let codes = [
            exit::SUCCESS,
            exit::FOUND_PROBLEMS,
            exit::ARGUMENTS,
            exit::RECIPE,
            exit::INPUT,
            exit::MACHINE,
            exit::BUG,
            exit::STOPPED,
        ];
        for code in codes {
            let start = format!("{code}  ");
            assert!(AFTER_HELP.lines().any(|line| line.trim_start().starts_with(&start)), "{code}");
        }
    }

    #[test]
    fn commands_are_sorted_and_well_formed() {
        let mut cli = cli();
        cli.build();
        cli.clone().debug_assert();
        check_group(&cli);
    }

    fn check_group(group: &clap::Command) {
        let names: Vec<&str> =
            group.get_subcommands().map(clap::Command::get_name).filter(|it| *it != "help").collect();
        assert!(names.is_sorted(), "{names:?}");
        for command in group.get_subcommands().filter(|it| it.get_name() != "help") {
            assert!(command.get_about().is_some(), "`{}` has no help", command.get_name());
            check_group(command);
        }
    }
}

//! [`source_of`]: the digest of the file of a policy.

use super::manners::Manners;
use super::place::Place;
use super::process::{end, in_group};
use cosfly_fingerprint::Digest;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::mpsc::channel;
use std::time::Duration;

/// Finds the file of a module without running the module itself.
const FIND: &str = "\
import importlib.util, os, sys
sys.path.insert(0, os.getcwd())
found = importlib.util.find_spec(sys.argv[1])
print(found.origin if found and found.has_location else '', end='')";
/// Time for it.
const LONGEST: Duration = Duration::from_secs(10);
/// Longest path that is read, bytes.
const LONGEST_PATH: u64 = 1 << 16;

/// Digest of the file of a policy in Python or ONNX: rows of another text of it are rows of another policy. `None` for other policies, and
/// where the file is not found.
pub fn source_of(place: &Place, manners: &Manners) -> Option<String> {
    let module = match place {
        Place::Onnx(policy) => return Some(policy.digest().to_string()),
        Place::Python { module, .. } => module,
        Place::Baseline { .. } | Place::Socket(_) => return None,
    };
    let mut command = Command::new(&manners.python);
    command.args(["-c", FIND, module]).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
    in_group(&mut command);
    let mut child = command.spawn().ok()?;
    let stdout = child.stdout.take()?;
    let (sender, found) = channel();
    std::thread::spawn(move || {
        let mut path = String::new();
        let read = stdout.take(LONGEST_PATH).read_to_string(&mut path);
        sender.send(read.ok().map(|_| PathBuf::from(path)))
    });
    let path = found.recv_timeout(LONGEST.min(manners.wait)).ok().flatten();
    // A package around the module may hang while it is looked at: the policy's own process says so later.
    end(&mut child);
    let path = path.filter(|path| path.is_file())?;
    std::fs::read(path).ok().map(|bytes| Digest::of(&bytes).to_string())
}

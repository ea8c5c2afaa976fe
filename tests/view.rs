//! `cosfly view` through the real binary: who may ask, what is served, what damaged and hostile datasets come to.

use crate::street::Street;
use crate::support::{Printed, cosfly};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A running viewer, ended with the test.
struct Viewer {
    process: Child,
    port: u16,
    token: String,
}

impl Viewer {
    fn start(folder: &Path, subject: &str) -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_cosfly"))
            .args(["view", subject, "--no-open"])
            .current_dir(folder)
            .env_remove("COSFLY_STORE")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("cosfly starts");
        let mut address = String::new();
        BufReader::new(process.stdout.as_mut().expect("a pipe")).read_line(&mut address).expect("an address");
        let rest = address.trim().strip_prefix("http://127.0.0.1:").expect("an address of this machine");
        let (port, token) = rest.split_once("/?token=").expect("a token");
        Self { port: port.parse().expect("a port"), token: token.to_owned(), process }
    }

    /// Status, headers and body of the answer to some bytes.
    fn send(&self, request: &str) -> (u16, String, Vec<u8>) {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        stream.set_read_timeout(Some(Duration::from_secs(20))).expect("set");
        stream.write_all(request.as_bytes()).expect("sent");
        let mut answer = vec![];
        stream.read_to_end(&mut answer).expect("an answer");
        let end = answer.windows(4).position(|four| four == b"\r\n\r\n").expect("headers");
        let head = String::from_utf8(answer[..end].to_vec()).expect("UTF-8");
        let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).expect("a status");
        (status, head, answer[end + 4..].to_vec())
    }

    fn get(&self, path: &str, headers: &str) -> (u16, String, Vec<u8>) {
        let host = if headers.contains("Host:") { String::new() } else { format!("Host: 127.0.0.1:{}\r\n", self.port) };
        self.send(&format!("GET {path} HTTP/1.1\r\n{host}{headers}Connection: close\r\n\r\n"))
    }

    /// The header with the cookie that the token gives.
    fn enter(&self) -> String {
        let (status, head, page) = self.get(&format!("/?token={}", self.token), "");
        assert_eq!(status, 200, "{head}");
        assert!(page.starts_with(b"<!DOCTYPE html>"));
        let cookie = head.lines().find_map(|line| line.strip_prefix("Set-Cookie: ")).expect("a cookie");
        assert!(cookie.ends_with("; Path=/; HttpOnly; SameSite=Strict"), "{cookie}");
        format!("Cookie: {}\r\n", cookie.split(';').next().expect("a pair"))
    }

    fn json(&self, path: &str, cookie: &str) -> (u16, serde_json::Value) {
        let (status, head, body) = self.get(path, cookie);
        (status, serde_json::from_slice(&body).unwrap_or_else(|error| panic!("{path}: {error}: {head}")))
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn made() -> Street {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    street
}

#[test]
fn a_dataset_is_served_to_the_browser_with_the_token_alone() {
    let street = made();
    let viewer = Viewer::start(street.path(), "out/street");
    for path in
        ["/", "/?token=0", "/api/index", "/main.js", "/picture/0/0/rgb", &format!("/api/index?token={}", viewer.token)]
    {
        assert_eq!(viewer.get(path, "").0, 403, "{path}");
    }
    let cookie = viewer.enter();
    assert_eq!(viewer.get(&format!("/?token={}", viewer.token), "").0, 403, "the token opens once");
    let (status, index) = viewer.json("/api/index", &cookie);
    let column = |name: &str| {
        let columns = index["columns"].as_array().expect("columns");
        columns.iter().find(|column| column["name"] == name).unwrap_or_else(|| panic!("{name}")).clone()
    };
    assert_eq!((status, index["flights"].as_u64()), (200, Some(6)));
    assert_eq!(column("role")["texts"].as_array().map(Vec::len), Some(6));
    let worst: Vec<u64> = index["worst"].as_array().expect("an order").iter().filter_map(|it| it.as_u64()).collect();
    let losses = |at: &u64| column("losses_s")["numbers"][*at as usize].as_f64().expect("a number");
    assert!(worst.is_sorted_by(|a, b| losses(a) >= losses(b)), "{worst:?}");
    let (_, flight) = viewer.json("/api/flight/0", &cookie);
    for name in ["time_s", "x", "visible", "target_x", "visible_box"] {
        assert_eq!(flight[name].as_array().map(Vec::len), Some(12), "{name}");
    }
    assert_eq!(flight["channels"], serde_json::json!(["rgb", "depth", "semantic", "instance"]));
    assert!(flight["captions"].as_array().is_some_and(|it| !it.is_empty()));
    assert_eq!(flight["family"].as_array().map(Vec::len), Some(2));
    let (_, town) = viewer.json("/api/town/0", &cookie);
    assert!(town["kinds"].as_object().is_some_and(|kinds| !kinds.is_empty()), "{town}");
    assert_eq!(viewer.json("/api/bodies/0", &cookie).0, 200);
    for (channel, start) in
        [("rgb", &b"\xff\xd8\xff"[..]), ("depth", b"\xff\xd8\xff"), ("semantic", b"\x89PNG"), ("instance", b"\x89PNG")]
    {
        let (status, head, picture) = viewer.get(&format!("/picture/0/11/{channel}"), &cookie);
        assert!(status == 200 && picture.starts_with(start), "{channel}: {head}");
        assert!(head.contains("nosniff") && head.contains("default-src 'none'"), "{head}");
    }
}

#[test]
fn hostile_requests_are_refused_and_the_viewer_goes_on() {
    let street = made();
    let viewer = Viewer::start(street.path(), "out/street");
    let cookie = viewer.enter();
    let host = format!("Host: 127.0.0.1:{}\r\n", viewer.port);
    for (status, path) in [
        (404, "/../../recipe.toml"),
        (404, "/%2e%2e/recipe.toml"),
        (404, "/README.md"),
        (404, "/data/frames/train-00000-of-00001.parquet"),
        (404, "/api/flight/99"),
        (404, "/api/flight/-1"),
        (404, "/api/flight/1e1"),
        (404, "/api/flight/99999999999999999999"),
        (404, "/api/flight/0/../1"),
        (404, "/picture/0/12/rgb"),
        (404, "/picture/0/0/..%2f..%2fsecret"),
        (404, "/picture/0/0/rgb/../../x"),
    ] {
        assert_eq!(viewer.get(path, &cookie).0, status, "{path}");
    }
    for headers in [
        "Host: evil.example\r\n",
        &format!("Host: evil.example:{}\r\n", viewer.port),
        &format!("{host}Origin: https://evil.example\r\n"),
        &format!("{host}Sec-Fetch-Site: cross-site\r\n"),
    ] {
        let status = viewer.get("/api/index", &format!("{headers}{cookie}")).0;
        assert!(status == 403 || status == 421, "{headers}: {status}");
    }
    for (status, request) in [
        (405, format!("POST /api/index HTTP/1.1\r\n{host}{cookie}\r\n")),
        (405, format!("DELETE / HTTP/1.1\r\n{host}{cookie}\r\n")),
        (400, "nonsense\r\n\r\n".to_owned()),
        (400, format!("GET / HTTP/1.1\r\n{host}{cookie}Content-Length: 9\r\n\r\n")),
        (431, format!("GET /{} HTTP/1.1\r\n{host}\r\n", "a".repeat(20_000))),
    ] {
        assert_eq!(viewer.send(&request).0, status, "{}", &request[..20.min(request.len())]);
    }
    // Connections that say nothing take no place once they end, and one too many is turned away.
    std::thread::sleep(Duration::from_millis(500));
    let idle: Vec<TcpStream> =
        (0..32).map(|_| TcpStream::connect(("127.0.0.1", viewer.port)).expect("it listens")).collect();
    let mut more = TcpStream::connect(("127.0.0.1", viewer.port)).expect("it listens");
    more.set_read_timeout(Some(Duration::from_secs(20))).expect("set");
    let mut answer = String::new();
    more.read_to_string(&mut answer).expect("an answer");
    assert!(answer.starts_with("HTTP/1.1 503"), "{answer}");
    drop(idle);
    std::thread::sleep(Duration::from_millis(500));
    assert_eq!(viewer.get("/api/about", &cookie).0, 200);
}

#[test]
#[cfg(unix)]
fn damaged_logs_are_told_and_links_out_of_the_dataset_are_not_followed() {
    let street = made();
    let dataset = street.dataset();
    let log = |name: &str| dataset.join(format!("mcap/street/000/{name}.mcap"));
    std::fs::write(log("expert-p00000"), b"no log").expect("writable");
    let outside = street.path().join("outside.mcap");
    std::fs::rename(log("expert-p00001"), &outside).expect("moved");
    std::os::unix::fs::symlink(&outside, log("expert-p00001")).expect("linked");
    std::fs::remove_file(log("expert-p00002")).expect("removed");
    let viewer = Viewer::start(street.path(), "out/street");
    let cookie = viewer.enter();
    let (_, index) = viewer.json("/api/index", &cookie);
    let names = index["columns"][0]["texts"].as_array().expect("names");
    let number = |name: &str| names.iter().position(|it| it == name).expect("a flight");
    for (name, words) in [("expert-p00000", "is damaged"), ("expert-p00001", "leads out of"), ("expert-p00002", "open")]
    {
        let (status, flight) = viewer.json(&format!("/api/flight/{}", number(name)), &cookie);
        let told = flight["problem"]["message"].as_str().unwrap_or_default();
        assert!(status == 200 && told.contains(words), "{name}: {told}");
        let (status, refusal) = viewer.json(&format!("/picture/{}/0/rgb", number(name)), &cookie);
        assert!(status == 422 && refusal["message"].as_str().is_some_and(|it| it.contains(words)), "{name}");
    }
    drop(viewer);
    let table = dataset.join("data/captions");
    std::fs::rename(&table, street.path().join("captions")).expect("moved");
    std::os::unix::fs::symlink(street.path().join("captions"), &table).expect("linked");
    insta::assert_snapshot!(
        "view_of_links",
        told(&cosfly(&["view", "out/street", "--no-open"]).within(street.path()).run())
    );
}

fn told(printed: &Printed) -> String {
    format!("exit code {}\n{}", printed.code.unwrap_or(-1), printed.stderr)
}

#[test]
fn what_cannot_be_shown_is_refused_and_a_page_is_exported() {
    let street = made();
    let view = |arguments: &[&str]| cosfly(&[&["view"], arguments].concat()).within(street.path()).run();
    for (name, arguments) in [
        ("view_of_nothing", &["nowhere", "--no-open"][..]),
        ("view_export_and_port", &["out/street", "--export", "a.html", "--port", "1"]),
    ] {
        let printed = view(arguments);
        insta::assert_snapshot!(name, told(&printed));
    }
    std::fs::create_dir(street.path().join("bare")).expect("writable");
    let bare = Viewer::start(street.path(), "bare");
    let about = bare.json("/api/about", &bare.enter()).1;
    assert!(about["reasons"][0].as_str().is_some_and(|words| words.contains("has no table `trajectories`")), "{about}");
    let printed = view(&["out/street", "--export", "page.html"]);
    assert!(
        printed.code == Some(0) && printed.stdout.contains("the worst 6 of 6 flights"),
        "{}{}",
        printed.stdout,
        printed.stderr
    );
    let page = std::fs::read_to_string(street.path().join("page.html")).expect("a page");
    assert!(page.contains("/picture/0/11/rgb") && page.contains("script-src 'sha256-") && page.len() < 50_000_000);
    view(&["out/street", "--export", "again.html"]);
    assert!(page == std::fs::read_to_string(street.path().join("again.html")).expect("a page"), "the same bytes twice");
}

#[test]
fn the_exported_page_of_a_result_has_the_towns_that_its_flights_name() {
    let street = Street::new();
    cosfly(&["fly", "recipe.toml", "--out", "flown", "--policy", "follow", "--clips", "0"])
        .within(street.path())
        .run_ok();
    cosfly(&["view", "flown/follow", "--export", "page.html"]).within(street.path()).run_ok();
    let page = std::fs::read_to_string(street.path().join("page.html")).expect("a page");
    let data = page.split_once("id=\"data\">").expect("data").1.split_once("</script>").expect("an end").0;
    let data: serde_json::Value = serde_json::from_str(data).expect("JSON");
    let held = data["held"].as_array().expect("flights");
    assert!(!held.is_empty());
    for number in held {
        let town = data[format!("/api/flight/{number}")]["town"].as_str().expect("a town");
        let kinds = data[format!("town {town}")]["kinds"].as_object();
        assert!(kinds.is_some_and(|kinds| !kinds.is_empty()), "flight {number} names `{town}`");
    }
}

#[test]
#[cfg(unix)]
fn a_result_tells_its_frames_and_no_file_of_it_leads_out() {
    let street = Street::new();
    let flown = street.path().join("flown");
    cosfly(&["fly", "recipe.toml", "--out", "flown", "--policy", "follow", "--clips", "0"])
        .within(street.path())
        .run_ok();
    let viewer = Viewer::start(street.path(), "flown");
    let (_, flight) = viewer.json("/api/flight/0", &viewer.enter());
    let frames = flight["x"].as_array().map_or(0, Vec::len);
    let reason = flight["reason"].as_str().expect("a reason");
    assert!(frames > 0 && reason.contains(&format!("(frame {})", frames - 1)), "{reason}");
    let longest = flight["losses"].as_array().expect("losses").iter().max_by_key(|it| {
        let at = |name: &str| it[name].as_u64().expect("a frame");
        (at("end") - at("from"), std::cmp::Reverse(at("from")))
    });
    if let Some(longest) = longest {
        assert!(reason.ends_with(&format!("from frame {}", longest["from"])), "{reason}");
    }
    drop(viewer);
    for name in ["card.json", "episodes.jsonl"] {
        let (file, outside) = (flown.join("follow").join(name), street.path().join(name));
        std::fs::rename(&file, &outside).expect("moved");
        std::os::unix::fs::symlink(&outside, &file).expect("linked");
        let refused = cosfly(&["view", "flown", "--no-open"]).within(street.path()).run();
        assert!(refused.stderr.contains("error[view-outside]") && refused.stderr.contains(name), "{}", refused.stderr);
        std::fs::remove_file(&file).expect("removed");
        std::fs::rename(&outside, &file).expect("moved back");
    }
}

#[test]
fn a_recipe_shows_what_of_it_is_made() {
    let street = Street::new();
    let progress = |viewer: &Viewer| {
        let (status, value) = viewer.json("/api/progress", &viewer.enter());
        assert_eq!(status, 200);
        value["stages"].as_array().expect("stages").clone()
    };
    assert!(progress(&Viewer::start(street.path(), "recipe.toml")).is_empty());
    cosfly(&["run", "recipe.toml", "--quiet", "--stage", "expert"]).within(street.path()).run_ok();
    let stages = progress(&Viewer::start(street.path(), "recipe.toml"));
    let of = |name: &str| stages.iter().find(|stage| stage["name"] == name).expect("a stage").clone();
    assert_eq!((of("expert")["made"].as_u64(), of("expert")["items"].as_u64()), (Some(3), Some(3)));
    assert_eq!(of("frames")["made"].as_u64(), Some(0));
    cosfly(&["run", "recipe.toml", "--quiet", "--stage", "frames"]).within(street.path()).run_ok();
    let filming = Viewer::start(street.path(), "recipe.toml");
    let cookie = filming.enter();
    let films = filming.json("/api/progress", &cookie).1["films"].clone();
    assert_eq!(films.as_array().expect("films").len(), 6, "{films}");
    let (status, _, picture) = filming.get(&format!("/picture/{}/0/rgb", films[1]["number"]), &cookie);
    assert!(status == 200 && picture.starts_with(&[0xff, 0xd8]), "the first picture of {}", films[1]["name"]);
    assert_eq!(filming.get("/picture/77/0/rgb", &cookie).0, 404);
    // A run that ends while the viewer is open: a reload shows its flights.
    let viewer = Viewer::start(street.path(), "recipe.toml");
    let cookie = viewer.enter();
    assert_eq!(viewer.json("/api/index", &cookie).1["flights"].as_u64(), Some(0));
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    assert_eq!(viewer.json("/api/about", &cookie).1["flights"].as_u64(), Some(6));
    assert_eq!(viewer.json("/api/index", &cookie).1["flights"].as_u64(), Some(6));
}

//! Input that means harm, or might as well: each ends in seconds, in little memory, with a message that names the file
//! and what to do. Through the binary, on Linux: sparse files, pipes, links, signals, and memory as the kernel counts it.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::fs::{self, File};
use std::io::{BufWriter, Seek as _, SeekFrom, Write};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use flate2::Compression;
use flate2::write::GzEncoder;

const TOML: &str = "[sensor]\nserial = \"x\"\n[output]\nquantizer = \"round\"\nnominal_scale = 0.0077\n\
                    rate_hz = 50.0\n[bench]\ngravity = 9.81\n";
const GIB: u64 = 1 << 30;
/// Largest resident memory, kB.
const MOST_KB: u64 = 300 << 10;
/// Longest run, with room for a busy machine and a binary without optimization.
const PATIENCE: Duration = Duration::from_secs(60);

/// How a call ended.
struct End {
    code: Option<i32>,
    out: String,
    err: String,
    /// Largest resident memory that was seen, kB.
    peak_kb: u64,
}

fn start(folder: &Path, args: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_tumble"))
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Largest resident memory of a process so far, kB.
fn peak_kb(pid: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    line.trim().trim_end_matches("kB").trim().parse().ok()
}

/// Waits for the end, and ends what does not end.
fn end(mut child: Child) -> End {
    let started = Instant::now();
    let mut peak = 0;
    // Drained meanwhile: a full pipe would hold the process up.
    let drain = |mut pipe: Box<dyn std::io::Read + Send>| {
        std::thread::spawn(move || {
            let mut bytes = Vec::new();
            let _ = pipe.read_to_end(&mut bytes);
            String::from_utf8_lossy(&bytes).into_owned()
        })
    };
    let out = drain(Box::new(child.stdout.take().unwrap()));
    let err = drain(Box::new(child.stderr.take().unwrap()));
    let status = loop {
        peak = peak.max(peak_kb(child.id()).unwrap_or(0));
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if started.elapsed() > PATIENCE {
            let _ = child.kill();
            panic!("did not end in {PATIENCE:?}, {peak} kB");
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    End { code: status.code(), out: out.join().unwrap(), err: err.join().unwrap(), peak_kb: peak }
}

fn tumble(folder: &Path, args: &[&str]) -> End {
    let ended = end(start(folder, args));
    assert!(ended.peak_kb < MOST_KB, "{args:?} took {} kB: {}", ended.peak_kb, ended.err);
    assert!(ended.err.len() < 20_000, "{} bytes of message: {:.300}", ended.err.len(), ended.err);
    assert!(!ended.err.contains("panicked"), "{}", ended.err);
    ended
}

/// An experiment with one run file.
fn experiment(file: &str) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("experiment.toml"), format!("{TOML}[[run]]\nfile = '{file}'\n"))
        .unwrap();
    dir
}

/// The refusal of an experiment: exit 2, and all words are named.
fn refused(dir: &Path, words: &[&str]) -> End {
    let ended = tumble(dir, &["certify", "."]);
    named(&ended, words);
    ended
}

fn named(ended: &End, words: &[&str]) {
    assert_eq!(ended.code, Some(2), "{} {}", ended.err, ended.out);
    assert_eq!(ended.out, "");
    for word in words {
        assert!(ended.err.contains(word), "`{}` does not name `{word}`", ended.err);
    }
}

/// A sparse file: a text, and holes up to a length.
fn sparse(path: &Path, text: &[u8], length: u64) {
    let mut file = File::create(path).unwrap();
    file.write_all(text).unwrap();
    file.set_len(length).unwrap();
}

/// Bytes that look like chance, the same every time.
fn noise(length: usize) -> Vec<u8> {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut bytes = Vec::with_capacity(length + 8);
    while bytes.len() < length {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        bytes.extend_from_slice(&state.to_le_bytes());
    }
    bytes.truncate(length);
    bytes
}

fn gz(bytes: &[u8]) -> Vec<u8> {
    let mut e = GzEncoder::new(Vec::new(), Compression::default());
    e.write_all(bytes).unwrap();
    e.finish().unwrap()
}

// --- garbage ---

#[test]
fn two_gigabytes_of_garbage_are_refused_at_once() {
    let dir = experiment("run.csv");
    let run = dir.path().join("run.csv");
    for text in [&b""[..], b"angle_deg,code\n", b"angle_deg,code\n-30,10\n-30,11\n", b"# a comment"]
    {
        sparse(&run, text, 2 * GIB);
        refused(dir.path(), &["run.csv", "line longer than", "is this a binary file?"]);
        let init = tumble(dir.path(), &["init", "run.csv", "--print"]);
        named(&init, &["run.csv"]);
    }
    sparse(&run, b"\x1f\x8b\x08\0\0\0\0\0\0\x03", 2 * GIB);
    refused(dir.path(), &["run.csv", "gzip file is damaged", "copy it again"]);
    sparse(&run, b"\x28\xb5\x2f\xfd", 2 * GIB);
    refused(dir.path(), &["run.csv", "zstd file is damaged"]);
}

#[test]
fn one_endless_line_is_refused() {
    let dir = experiment("run.csv");
    let run = dir.path().join("run.csv");
    sparse(&run, b"angle_deg,code\n0,1", 2 * GIB);
    let mut file = File::options().write(true).open(&run).unwrap();
    file.seek(SeekFrom::Start(15)).unwrap();
    (0..64).for_each(|_| file.write_all(&[b'7'; 1 << 16]).unwrap());
    refused(dir.path(), &["run.csv, line 2", "line longer than"]);
}

#[test]
fn fifty_megabytes_of_chance_are_refused() {
    let dir = experiment("run.csv");
    let run = dir.path().join("run.csv");
    for start in
        [&b""[..], b"angle_deg,code\n", b"\x1f\x8b\x08\0\0\0\0\0\0\x03", b"\x28\xb5\x2f\xfd\0\x58"]
    {
        let mut file = File::create(&run).unwrap();
        file.write_all(start).unwrap();
        file.write_all(&noise(50_000_000)).unwrap();
        drop(file);
        refused(dir.path(), &["run.csv"]);
        named(&tumble(dir.path(), &["init", "run.csv", "--print"]), &["run.csv"]);
    }
}

// --- bombs ---

/// One member of many rows, again and again: gzip files may be joined.
fn gz_bomb(path: &Path, header: &[u8], row: &[u8], gigabyte: u64) {
    const MEMBER: usize = 16 << 20;
    let rows: Vec<u8> = row.iter().copied().cycle().take(MEMBER / row.len() * row.len()).collect();
    let member = gz(&rows);
    let mut file = BufWriter::new(File::create(path).unwrap());
    file.write_all(&gz(header)).unwrap();
    (0..gigabyte * GIB / MEMBER as u64).for_each(|_| file.write_all(&member).unwrap());
}

/// Blocks of one byte repeated: 128 KiB in four bytes.
fn zst_bomb(path: &Path, header: &[u8], byte: u8, blocks: u32) {
    let mut file = BufWriter::new(File::create(path).unwrap());
    let block = |size: u32, kind: u32, last: u32| (size << 3 | kind << 1 | last).to_le_bytes();
    // A window of 2 MiB.
    file.write_all(b"\x28\xb5\x2f\xfd\0\x58").unwrap();
    file.write_all(&block(header.len() as u32, 0, 0)[..3]).unwrap();
    file.write_all(header).unwrap();
    for i in 1..=blocks {
        file.write_all(&block(1 << 17, 1, u32::from(i == blocks))[..3]).unwrap();
        file.write_all(&[byte]).unwrap();
    }
}

#[test]
fn bombs_are_refused() {
    let dir = experiment("run.csv.gz");
    let run = dir.path().join("run.csv.gz");
    gz_bomb(&run, b"angle_deg,code\n", &[0], 1);
    refused(dir.path(), &["run.csv.gz", "line longer than"]);
    gz_bomb(&run, b"angle_deg,code\n", b"\n", 1);
    refused(dir.path(), &["run.csv.gz", "times its size", "unpack it"]);
    // Within the bounds of what a record could be, until it is too much.
    gz_bomb(&run, b"angle_deg,code\n", b"0,0\n", 1);
    let ended = tumble(dir.path(), &["certify", "."]);
    named(&ended, &["run.csv.gz", "times its size"]);
    let dir = experiment("run.csv.zst");
    let run = dir.path().join("run.csv.zst");
    zst_bomb(&run, b"angle_deg,code\n0,1\n", b'\n', 1 << 14);
    refused(dir.path(), &["run.csv.zst", "times its size", "unpack it"]);
    zst_bomb(&run, b"angle_deg,code\n", 0, 1 << 14);
    refused(dir.path(), &["run.csv.zst", "line longer than"]);
    named(&tumble(dir.path(), &["init", "run.csv.zst", "--print"]), &["run.csv.zst"]);
}

#[test]
fn packed_files_that_are_damaged_are_named() {
    let text = b"angle_deg,code\n-30,10\n-30,12\n30,-7\n".to_vec();
    let whole = gz(&text);
    let mut flipped = whole.clone();
    let checksum = flipped.len() - 6;
    flipped[checksum] ^= 1;
    let cases = [
        [&whole[..], b"garbage"].concat(),
        whole[..whole.len() - 9].to_vec(),
        whole[..whole.len() - 2].to_vec(),
        flipped,
    ];
    let dir = experiment("run.csv.gz");
    for case in cases {
        fs::write(dir.path().join("run.csv.gz"), case).unwrap();
        refused(dir.path(), &["run.csv.gz", "gzip file is damaged", "copy it again"]);
    }
    let dir = experiment("run.csv.zst");
    let run = dir.path().join("run.csv.zst");
    zst_bomb(&run, &text, b'\n', 1);
    let whole = fs::read(&run).unwrap();
    fs::write(&run, &whole[..whole.len() - 2]).unwrap();
    refused(dir.path(), &["run.csv.zst", "zstd file is damaged", "copy it again"]);
    // The flag of a checksum, and one that is wrong.
    let mut summed = [&whole[..], &[1, 2, 3, 4]].concat();
    summed[4] |= 4;
    fs::write(&run, summed).unwrap();
    refused(dir.path(), &["run.csv.zst", "checksum"]);
}

// --- files that change ---

/// Rows of a run of a given size in bytes.
fn rows(path: &Path, bytes: usize) {
    let mut file = BufWriter::new(File::create(path).unwrap());
    file.write_all(b"angle_deg,code\n").unwrap();
    let row = b"-30,1108\n-30,1109\n".repeat(1 << 12);
    (0..bytes / row.len()).for_each(|_| file.write_all(&row).unwrap());
}

#[test]
fn files_that_are_written_to_meanwhile_are_refused() {
    let dir = experiment("run.csv");
    let run = dir.path().join("run.csv");
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        rows(&run, 4 << 20);
        scope.spawn(|| {
            let mut file = File::options().append(true).open(&run).unwrap();
            while !stop.load(Ordering::SeqCst) {
                // Half a row at a time, at most some megabytes.
                let _ = file.write_all(b"-30,1").and_then(|()| file.write_all(b"108\n"));
                std::thread::sleep(Duration::from_micros(50));
            }
        });
        let ended = tumble(dir.path(), &["certify", "."]);
        stop.store(true, Ordering::SeqCst);
        named(&ended, &["run.csv", "was written to while it was read", "stop the logger"]);
    });
}

#[test]
fn files_that_are_cut_meanwhile_are_refused() {
    let dir = experiment("run.csv");
    let run = dir.path().join("run.csv");
    rows(&run, 64 << 20);
    let child = start(dir.path(), &["certify", "."]);
    wait_for_reading(&child, 1 << 20);
    File::options().write(true).open(&run).unwrap().set_len(1 << 19).unwrap();
    let ended = end(child);
    named(&ended, &["run.csv", "was written to while it was read"]);
}

/// Waits until a process has read so many bytes.
fn wait_for_reading(child: &Child, bytes: u64) {
    let started = Instant::now();
    loop {
        let io = fs::read_to_string(format!("/proc/{}/io", child.id())).unwrap_or_default();
        let read = io.lines().find_map(|l| l.strip_prefix("rchar: ")).and_then(|n| n.parse().ok());
        if read.unwrap_or(0) > bytes {
            return;
        }
        assert!(started.elapsed() < PATIENCE, "nothing is read: {io}");
        std::thread::yield_now();
    }
}

// --- what is no file, or no file of this folder ---

#[test]
fn paths_out_of_the_folder_are_refused() {
    let outside = tempfile::tempdir().unwrap();
    fs::write(outside.path().join("run.csv"), "angle_deg,code\n0,1\n").unwrap();
    let absolute = outside.path().join("run.csv").display().to_string();
    for file in [
        "../run.csv",
        "a/../../run.csv",
        "/etc/hostname",
        &absolute,
        "C:\\x",
        "..\\run.csv",
        "a\\b.csv",
        "",
        ".",
    ] {
        let dir = experiment(file);
        fs::create_dir(dir.path().join("a")).unwrap();
        refused(dir.path(), &[]);
    }
    let dir = experiment("run.csv");
    symlink(outside.path().join("run.csv"), dir.path().join("run.csv")).unwrap();
    refused(dir.path(), &["leaves the experiment folder", "copy the file"]);
    let dir = experiment("data/run.csv");
    symlink(outside.path(), dir.path().join("data")).unwrap();
    refused(dir.path(), &["leaves the experiment folder"]);
    let dir = experiment("run.csv");
    symlink("run.csv", dir.path().join("run.csv")).unwrap();
    refused(dir.path(), &["run.csv"]);
    let long = "x".repeat(300);
    refused(experiment(&long).path(), &["xxx"]);
    refused(experiment("run.csv/x").path(), &["run.csv/x"]);
}

#[test]
fn what_is_no_file_is_refused_without_waiting() {
    let pipe = |path: &Path| assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    let dir = experiment("run.csv");
    pipe(&dir.path().join("run.csv"));
    refused(dir.path(), &["run.csv", "no regular file"]);
    named(&tumble(dir.path(), &["init", "run.csv"]), &["run.csv", "no regular file"]);
    let dir = experiment("run.csv");
    symlink("/dev/zero", dir.path().join("run.csv")).unwrap();
    refused(dir.path(), &["leaves the experiment folder"]);
    named(&tumble(dir.path(), &["init", "run.csv"]), &["run.csv", "no regular file"]);
    let dir = experiment("run.csv");
    fs::create_dir(dir.path().join("run.csv")).unwrap();
    refused(dir.path(), &["run.csv", "a folder, not a file"]);
    // The same for experiment.toml.
    let dir = tempfile::tempdir().unwrap();
    let toml = dir.path().join("experiment.toml");
    pipe(&toml);
    refused(dir.path(), &["experiment.toml", "no regular file"]);
    fs::remove_file(&toml).unwrap();
    symlink("/dev/zero", &toml).unwrap();
    refused(dir.path(), &["experiment.toml", "no regular file"]);
    fs::remove_file(&toml).unwrap();
    fs::create_dir(&toml).unwrap();
    refused(dir.path(), &["experiment.toml", "a folder, not a file"]);
}

#[test]
fn files_that_may_not_be_read_are_named() {
    use std::os::unix::fs::PermissionsExt as _;
    let dir = experiment("run.csv");
    let run = dir.path().join("run.csv");
    fs::write(&run, "angle_deg,code\n0,1\n").unwrap();
    fs::set_permissions(&run, fs::Permissions::from_mode(0o0)).unwrap();
    if File::open(&run).is_ok() {
        eprintln!("SKIPPED: whoever runs this may read everything");
        return;
    }
    refused(dir.path(), &["run.csv", "allow yourself to read it"]);
}

// --- documents ---

#[test]
fn documents_out_of_all_proportion_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let toml = dir.path().join("experiment.toml");
    fs::write(&toml, format!("{TOML}{}", "# nothing\n".repeat(5_000_000))).unwrap();
    refused(dir.path(), &["experiment.toml", "more than 4 MiB"]);
    sparse(&toml, TOML.as_bytes(), 2 * GIB);
    refused(dir.path(), &["experiment.toml", "more than 4 MiB"]);
    for nested in [
        "x = ".to_owned() + &"[".repeat(100_000),
        "[".repeat(100_000),
        "{a=".repeat(50_000),
        "x = ".to_owned() + &"{a=".repeat(50_000),
    ] {
        fs::write(&toml, nested).unwrap();
        refused(dir.path(), &["experiment.toml, line 1"]);
    }
    fs::write(&toml, format!("{TOML}{}", "[[run]]\n".repeat(1_000_000))).unwrap();
    refused(dir.path(), &["experiment.toml", "more than 4 MiB"]);
    fs::write(&toml, format!("{TOML}{}", "[[run]]\n".repeat(400_000))).unwrap();
    refused(dir.path(), &["experiment.toml", "400000 tables", "at most 1000 runs"]);
    let keys: String = (0..100_000).map(|i| format!("key{i} = 1\n")).collect();
    fs::write(&toml, keys).unwrap();
    refused(dir.path(), &["experiment.toml", "unknown key"]);
}

#[test]
fn passports_out_of_all_proportion_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let passport = dir.path().join("passport.json");
    let compensate =
        |words: &[&str]| named(&tumble(dir.path(), &["compensate", "passport.json"]), words);
    fs::write(&passport, b" ".repeat(100_000_000)).unwrap();
    compensate(&["passport.json", "more than 32 MiB", "tumble certify"]);
    sparse(&passport, b"{\"schema\": \"tumble-passport/1\"", 2 * GIB);
    compensate(&["passport.json", "more than 32 MiB"]);
    fs::write(&passport, b"[".repeat(30_000_000)).unwrap();
    compensate(&["passport.json", "not a passport"]);
    let nested = format!("{{\"schema\":\"tumble-passport/1\",\"extra\":{}", "[".repeat(1_000_000));
    fs::write(&passport, nested).unwrap();
    compensate(&["passport.json", "not a passport"]);
    fs::write(&passport, [0xff; 100]).unwrap();
    compensate(&["passport.json", "not UTF-8"]);
    fs::remove_file(&passport).unwrap();
    symlink("/dev/zero", &passport).unwrap();
    compensate(&["passport.json", "more than 32 MiB"]);
    fs::remove_file(&passport).unwrap();
    compensate(&["passport.json", "is the name right"]);
}

// --- run files out of all proportion ---

#[test]
fn headers_out_of_all_proportion_are_refused_in_few_words() {
    let dir = experiment("run.csv");
    let run = dir.path().join("run.csv");
    // A million columns are more than a line holds.
    fs::write(&run, format!("angle_deg,code{}\n0,1\n", ",x".repeat(1_000_000))).unwrap();
    refused(dir.path(), &["run.csv, line 1", "line longer than"]);
    fs::write(&run, format!("angle_deg,code{}\n0,1\n", ",x".repeat(500_000))).unwrap();
    refused(dir.path(), &["run.csv, line 2", "fields"]);
    fs::write(&run, format!("angle,code{}\n0,1\n", ",x".repeat(500_000))).unwrap();
    refused(dir.path(), &["run.csv, line 1", "and 499962 more"]);
    fs::write(&run, format!("{},code\n0,1\n", "x".repeat(900_000))).unwrap();
    refused(dir.path(), &["run.csv, line 1", "no column `angle_deg`"]);
    // What is not used is named in few words, too.
    let wide = format!("angle_deg,code{}\n", ",x".repeat(20_000));
    let row = |a: i32| format!("{a},{}{}\n", 10 * a, ",1".repeat(20_000));
    fs::write(&run, wide + &(-3..4).map(|a| row(10 * a)).collect::<String>()).unwrap();
    let read = tumble(dir.path(), &["check", "."]);
    assert_eq!(read.code, Some(0), "{}", read.err);
    assert!(read.out.contains("and 19960 more") && read.out.len() < 20_000, "{:.2000}", read.out);
}

#[test]
fn a_million_angles_are_no_angles() {
    let dir = experiment("run.csv");
    let run = dir.path().join("run.csv");
    let mut file = BufWriter::new(File::create(&run).unwrap());
    file.write_all(b"angle_deg,code\n").unwrap();
    (0..1_000_000).for_each(|i| writeln!(file, "{}.{:06},{}", i % 60, i, i % 4096).unwrap());
    drop(file);
    refused(dir.path(), &["run.csv, line 1000", "more than 10000 dwells", "angle column"]);
}

#[test]
fn two_million_codes_are_no_dwell() {
    let dir = experiment("run.csv");
    let run = dir.path().join("run.csv");
    let mut file = BufWriter::new(File::create(&run).unwrap());
    file.write_all(b"angle_deg,code\n").unwrap();
    (0..2_000_000u32).for_each(|i| {
        let code = i.wrapping_mul(2_654_435_761) as i32;
        writeln!(file, "0,{code}").unwrap();
    });
    drop(file);
    refused(dir.path(), &["run.csv, line", "different codes", "angle column"]);
}

// --- Ctrl-C ---

fn interrupt(child: &Child) {
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
}

/// Names in a folder that no finished call leaves.
fn unfinished(folder: &Path) -> Vec<String> {
    let names =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    names.filter(|n| n.contains("tumble-new")).collect()
}

#[test]
fn an_interrupted_reading_ends_at_once() {
    let dir = experiment("run.csv");
    rows(&dir.path().join("run.csv"), 256 << 20);
    for args in
        [&["certify", ".", "--out", "out"][..], &["check", "."], &["init", "run.csv", "--replace"]]
    {
        let child = start(dir.path(), args);
        wait_for_reading(&child, 1 << 20);
        interrupt(&child);
        let sent = Instant::now();
        let ended = end(child);
        assert_eq!(ended.code, Some(130), "{args:?}: {}", ended.err);
        assert!(sent.elapsed() < Duration::from_secs(5), "{args:?}");
        assert!(unfinished(dir.path()).is_empty() && !dir.path().join("out").exists());
        assert!(!dir.path().join("experiment.toml.old-1").exists());
    }
}

/// Interrupts a call at many moments; afterwards the result is whole or not there.
fn interrupted_anywhere(args: &[&str], prepare: &dyn Fn(&Path), whole: &dyn Fn(&Path) -> bool) {
    let dir = tempfile::tempdir().unwrap();
    prepare(dir.path());
    let started = Instant::now();
    let code = tumble(dir.path(), args).code;
    let length = started.elapsed();
    assert!(matches!(code, Some(0 | 1 | 4)), "{args:?}: {code:?}");
    assert!(whole(dir.path()));
    for moment in 1..=16 {
        let dir = tempfile::tempdir().unwrap();
        prepare(dir.path());
        let child = start(dir.path(), args);
        std::thread::sleep(length * moment / 16);
        interrupt(&child);
        let ended = end(child);
        // Before the handler stands, the signal ends the process itself.
        let ended_so = matches!(ended.code, None | Some(130)) || ended.code == code;
        assert!(ended_so, "{args:?}: {:?} {}", ended.code, ended.err);
        assert!(unfinished(dir.path()).is_empty(), "{args:?}: {:?}", unfinished(dir.path()));
        assert!(whole(dir.path()) || ended.code != code, "{args:?}");
    }
}

#[test]
fn an_interrupted_writing_leaves_nothing_half_done() {
    let run: String = (-30..30)
        .flat_map(|a| [format!("{a},{}\n", 22 * a), format!("{a},{}\n", 22 * a + 1)])
        .collect();
    let prepare = |folder: &Path| {
        fs::write(folder.join("run.csv"), format!("angle_deg,code\n{run}")).unwrap();
        fs::write(folder.join("experiment.toml"), format!("{TOML}[[run]]\nfile = \"run.csv\"\n"))
            .unwrap();
    };
    let certified = |folder: &Path| {
        let out = folder.join("out");
        let whole = ["passport.json", "passport.html", "figures/residuals.svg"]
            .iter()
            .all(|f| out.join(f).exists());
        // There whole, or not at all.
        assert!(whole || !out.exists(), "a partial folder");
        whole
    };
    interrupted_anywhere(&["certify", ".", "--out", "out"], &prepare, &certified);
    let drafted = |folder: &Path| {
        let text = fs::read_to_string(folder.join("experiment.toml")).unwrap();
        let old = folder.join("experiment.toml.old-1").exists();
        // The old one, or the new one with the old one beside it.
        assert!(text.starts_with(if old { "# Written by" } else { "[sensor]" }), "{text:.80}");
        old
    };
    interrupted_anywhere(&["init", "run.csv", "--replace"], &prepare, &drafted);
}

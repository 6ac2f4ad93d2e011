//! `permutations --emit`: a folder with each distinct program once, and a manifest that says which permutation has which.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::hash::Hasher;
use std::path::Path;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;
use shadewright::compiler::space::{Chosen, Permutation, Space, Work, compile_all};
use shadewright::compiler::{Program, Report};
use siphasher::sip128::{Hasher128, SipHasher13};

use super::super::emit::{Language, shader};
use super::super::failure::Failure;
use super::super::output::{Outputs, json, say, say_json};
use super::super::watch::Watch;
use super::super::{Context, Format};
use super::{CHUNK, Options, Tally, index, sampled};

/// Version of the manifest's form.
const VERSION: u32 = 1;
const MANIFEST: &str = "manifest.json";
/// How long work may go on before what is done is noted in the manifest.
const NOTE: Duration = Duration::from_secs(2);

/// `manifest.json`.
#[derive(Debug, Serialize, Deserialize)]
struct Manifest {
    /// Of this form.
    version: u32,
    /// Whether all that was asked for is here.
    complete: bool,
    /// Hash of the space's text.
    space: String,
    target: String,
    pass: String,
    sample: String,
    /// Programs, distinct ones among them, and their ratio.
    programs: usize,
    distinct: usize,
    ratio: f64,
    /// In the order of the sample.
    permutations: Vec<Entry>,
    /// Hash of each file's bytes.
    files: BTreeMap<String, String>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Entry {
    index: Option<String>,
    choices: Vec<Chosen>,
    recipe: String,
    /// What its programs depend on: [`Catalog::key`](shadewright::compiler::Catalog::key). None where the recipe stands for no tree.
    key: Option<String>,
    programs: Vec<Written>,
}

/// A pass of a permutation.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Written {
    pass: String,
    /// Canonical hash; none where it does not compile.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hash: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    files: Vec<String>,
    /// Why it does not compile.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    diagnostics: Option<Json>,
}

/// What a thread made of a pass: its hash and, unless it is known to be there, its files.
struct Made {
    pass: String,
    result: Result<(String, Files), Report>,
}

/// Names and bytes of a program's files.
type Files = Vec<(String, Vec<u8>)>;

/// # Errors
/// The folder cannot be written to or holds another manifest, or permutations do not compile.
pub fn emit(context: &Context, space: &Space, options: &Options, folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| Failure::message(format!("{}: {error}", folder.display())))?;
    let mut manifest = Manifest {
        version: VERSION,
        complete: false,
        space: digest(space.source().text.as_bytes()),
        target: options
            .target
            .to_possible_value()
            .map_or_else(String::new, |value| value.get_name().to_owned()),
        pass: options.pass.clone(),
        sample: match options.sample {
            super::Sample::All => "all".to_owned(),
            super::Sample::Pairwise => "pairwise".to_owned(),
            super::Sample::Random(number) => format!("random:{number} seed {}", options.seed),
        },
        programs: 0,
        distinct: 0,
        ratio: 1.0,
        permutations: Vec::new(),
        files: BTreeMap::new(),
    };
    let done = earlier(folder, &manifest)?;
    let drawn = sampled(space, options)?;
    let mut writer = Writer {
        folder,
        language: options.target,
        tally: Tally::default(),
        known: BTreeMap::new(),
        reused: 0,
        noted: Instant::now(),
    };
    let watch = Watch::new(drawn.number, "permutations");
    let mut iter = drawn.iter;
    let mut interrupted = false;
    while !interrupted {
        let chunk: Vec<Permutation> = iter.by_ref().take(CHUNK).collect();
        if chunk.is_empty() {
            break;
        }
        interrupted = !writer.chunk(context, options, &watch, &done, &chunk, &mut manifest)?;
    }
    watch.finish();
    if !interrupted {
        writer.tally.not_empty(&options.pass)?;
    }
    manifest.complete = !interrupted;
    writer.note(&mut manifest, Outputs::default())?;
    if interrupted {
        let text = format!(
            "{} of {} permutations are in {}; the same command goes on",
            writer.tally.permutations,
            drawn.number,
            folder.display()
        );
        return Err(Failure::Interrupted(text));
    }
    writer.say(context.format, &manifest)
}

struct Writer<'a> {
    folder: &'a Path,
    language: Language,
    tally: Tally,
    /// Files of each program that is in the folder.
    known: BTreeMap<String, Vec<String>>,
    /// Permutations that were there already.
    reused: usize,
    noted: Instant,
}

impl Writer<'_> {
    /// Compiles and writes some permutations. `false` where Ctrl-C was pressed; then those before are written.
    fn chunk(
        &mut self,
        context: &Context,
        options: &Options,
        watch: &Watch,
        done: &Earlier,
        chunk: &[Permutation],
        manifest: &mut Manifest,
    ) -> Result<bool, Failure> {
        let key = |p: &Permutation| context.catalog.key(&p.recipe, &options.pass).ok().map(|key| format!("{key:032x}"));
        let keys: Vec<Option<String>> = chunk.iter().map(key).collect();
        let earlier = done.that_hold(&keys, self.known.keys());
        let missing = chunk.iter().zip(&earlier).filter(|(_, entry)| entry.is_none());
        let fresh: Vec<Permutation> = missing.map(|(permutation, _)| permutation.clone()).collect();
        let work = Work {
            passes: options.passes(),
            threads: options.threads,
            cancel: watch.cancel(),
            progress: &|_| watch.step(),
        };
        let known: BTreeSet<&String> = self.known.keys().collect();
        let language = self.language;
        let mut made = compile_all(&context.catalog, &fresh, &work, |_, compiled| {
            let make = |(pass, result): (String, Result<Program, Report>)| Made {
                pass,
                result: result.and_then(|program| {
                    let hash = program.reflection().hash.clone();
                    let files = if known.contains(&hash) {
                        Vec::new()
                    } else {
                        files(&program, language)?
                    };
                    Ok((hash, files))
                }),
            };
            compiled.into_iter().map(make).collect::<Vec<_>>()
        })
        .into_iter();
        let mut outputs = Outputs::default();
        for ((permutation, key), entry) in chunk.iter().zip(keys).zip(earlier) {
            let programs = match entry {
                Some(entry) => {
                    self.reused += 1;
                    watch.step();
                    self.reuse(entry, &done.files, manifest)
                }
                None => match made.next().flatten() {
                    Some(made) => self.write(permutation, made, manifest, &mut outputs)?,
                    None => {
                        outputs.commit()?;
                        return Ok(false);
                    }
                },
            };
            self.tally.permutations += 1;
            manifest.permutations.push(Entry {
                index: index(permutation),
                choices: permutation.choices.clone(),
                recipe: permutation.recipe.source.text.clone(),
                key,
                programs,
            });
        }
        if self.noted.elapsed() > NOTE {
            self.note(manifest, outputs)?;
        } else {
            outputs.commit()?;
        }
        Ok(true)
    }

    fn reuse(&mut self, entry: &Entry, files: &BTreeMap<String, String>, manifest: &mut Manifest) -> Vec<Written> {
        for program in &entry.programs {
            let Some(hash) = &program.hash else { continue };
            self.count(hash);
            // Files of a program that was met before are another permutation's, perhaps written anew.
            if self.known.contains_key(hash) {
                continue;
            }
            self.known.insert(hash.clone(), program.files.clone());
            for name in &program.files {
                if let Some(digest) = files.get(name) {
                    manifest.files.insert(name.clone(), digest.clone());
                }
            }
        }
        entry.programs.clone()
    }

    fn write(
        &mut self,
        permutation: &Permutation,
        made: Vec<Made>,
        manifest: &mut Manifest,
        outputs: &mut Outputs,
    ) -> Result<Vec<Written>, Failure> {
        let mut programs = Vec::new();
        for Made { pass, result } in made {
            let (hash, files) = match result {
                Ok(made) => made,
                Err(report) => {
                    self.tally.fail(permutation, &pass, &report);
                    programs.push(Written {
                        pass,
                        hash: None,
                        files: Vec::new(),
                        diagnostics: Some(report.to_json()),
                    });
                    continue;
                }
            };
            self.count(&hash);
            if !self.known.contains_key(&hash) {
                let mut names = Vec::new();
                for (name, bytes) in files {
                    let path = self.folder.join(&name);
                    let digest = digest(&bytes);
                    // Left there by a run that could not note it: renaming an equal file over it would only change its time.
                    if digest_of(&path).as_ref() != Some(&digest) {
                        outputs.stage(&path, &bytes)?;
                    }
                    manifest.files.insert(name.clone(), digest);
                    names.push(name);
                }
                self.known.insert(hash.clone(), names);
            }
            programs.push(Written {
                pass,
                files: self.known.get(&hash).cloned().unwrap_or_default(),
                hash: Some(hash),
                diagnostics: None,
            });
        }
        Ok(programs)
    }

    fn count(&mut self, hash: &str) {
        self.tally.programs += 1;
        // A hash of ours is always hexadecimal.
        self.tally.distinct.insert(u128::from_str_radix(hash, 16).unwrap_or_default());
    }

    /// Puts files in their places, and the manifest that names them last.
    fn note(&mut self, manifest: &mut Manifest, mut outputs: Outputs) -> Result<(), Failure> {
        manifest.programs = self.tally.programs;
        manifest.distinct = self.tally.distinct.len();
        manifest.ratio = self.tally.ratio();
        outputs.stage(&self.folder.join(MANIFEST), format!("{}\n", json(manifest)?).as_bytes())?;
        outputs.commit()?;
        self.noted = Instant::now();
        Ok(())
    }

    fn say(self, format: Format, manifest: &Manifest) -> Result<(), Failure> {
        let failed = self.tally.failed.is_empty();
        match format {
            Format::Json => say_json(&serde_json::json!({
                "permutations": self.tally.permutations.to_string(),
                "programs": manifest.programs,
                "distinct": manifest.distinct,
                "ratio": manifest.ratio,
                "kept": self.reused,
                "files": manifest.files.len(),
                "failed": self.tally.failed,
            }))?,
            Format::Text => {
                for text in &self.tally.texts {
                    say(text)?;
                }
                let kept = match self.reused {
                    0 => String::new(),
                    kept => format!("; {kept} permutations were there already"),
                };
                say(&format!(
                    "{}, {} files in {}{kept}",
                    self.tally.text(),
                    manifest.files.len(),
                    self.folder.display()
                ))?;
            }
        }
        if failed { Ok(()) } else { Err(Failure::Said) }
    }
}

/// The files of a program, named by its hash.
fn files(program: &Program, language: Language) -> Result<Files, Report> {
    let hash = &program.reflection().hash;
    let ending = match language {
        Language::Wgsl | Language::WgslIr => "wgsl",
        Language::Spirv => "spv",
        Language::Hlsl => "hlsl",
        Language::Msl => "metal",
        // One entry point a file.
        Language::Glsl => {
            let entries = program.reflection().entry_points.iter();
            let file = |name: &String| Ok((format!("{hash}.{name}.glsl"), shader(program, language, Some(name))?));
            return entries.map(|entry| file(&entry.name)).collect();
        }
    };
    Ok(vec![(format!("{hash}.{ending}"), shader(program, language, None)?)])
}

/// What a run before this one left, as far as it still holds.
#[derive(Default)]
struct Earlier {
    /// By key: permutations all of whose files are there and whole.
    entries: HashMap<String, Entry>,
    /// By hash of a program: the key of the permutation whose text is in its files, the first that has it.
    writers: HashMap<String, String>,
    files: BTreeMap<String, String>,
}

impl Earlier {
    /// For the key of each permutation the entry that still says what comes of it. Of permutations with one program the first one's text is
    /// written, so the first of those that there are now must be the one whose text is there, or it is compiled again.
    fn that_hold<'a: 'k, 'k>(&'a self, keys: &[Option<String>], known: impl Iterator<Item = &'k String>) -> Vec<Option<&'a Entry>> {
        let mut known: HashSet<&'k String> = known.collect();
        let holds = |key: &Option<String>| {
            let key = key.as_ref()?;
            let entry = self.entries.get(key)?;
            let hashes = || entry.programs.iter().filter_map(|program| program.hash.as_ref());
            if !hashes().all(|hash| known.contains(hash) || self.writers.get(hash) == Some(key)) {
                return None;
            }
            known.extend(hashes());
            Some(entry)
        };
        keys.iter().map(holds).collect()
    }
}

fn earlier(folder: &Path, now: &Manifest) -> Result<Earlier, Failure> {
    let path = folder.join(MANIFEST);
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Earlier::default()),
        Err(error) => return Err(Failure::message(format!("{}: cannot be read: {error}", path.display()))),
    };
    let foreign = |why: String| {
        Failure::message(format!(
            "{}: is no manifest of permutations ({why}); name another folder",
            path.display()
        ))
    };
    let manifest: Manifest = serde_json::from_str(&text).map_err(|error| foreign(error.to_string()))?;
    if manifest.version != now.version {
        return Err(foreign(format!("version {}, not {VERSION}", manifest.version)));
    }
    // Another target has other files, another pass other programs. Files of other programs have other names.
    if (&manifest.target, &manifest.pass) != (&now.target, &now.pass) {
        return Ok(Earlier::default());
    }
    let whole: BTreeMap<String, String> = manifest
        .files
        .into_iter()
        .filter(|(name, digest)| !name.contains(['/', '\\']) && digest_of(&folder.join(name)).as_ref() == Some(digest))
        .collect();
    let good = |entry: &Entry| {
        let mut programs = entry.programs.iter();
        !entry.programs.is_empty() && programs.all(|p| is_whole(p, &whole))
    };
    let mut done = Earlier::default();
    for entry in manifest.permutations {
        let Some(key) = &entry.key else { continue };
        for hash in entry.programs.iter().filter_map(|program| program.hash.as_ref()) {
            done.writers.entry(hash.clone()).or_insert_with(|| key.clone());
        }
        if good(&entry) {
            done.entries.insert(key.clone(), entry);
        }
    }
    done.files = whole;
    Ok(done)
}

/// Whether a program has a hash as ours are, and files of that name which are all there: somebody may have edited the manifest.
fn is_whole(program: &Written, whole: &BTreeMap<String, String>) -> bool {
    let Some(hash) = &program.hash else { return false };
    let is_hash = hash.len() == 32 && hash.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'));
    let its_own = |name: &String| whole.contains_key(name) && name.strip_prefix(hash.as_str()).is_some_and(|rest| rest.starts_with('.'));
    is_hash && !program.files.is_empty() && program.files.iter().all(its_own)
}

/// Hash of a file's bytes; `None` where it is not there.
fn digest_of(path: &Path) -> Option<String> {
    Some(digest(&std::fs::read(path).ok()?))
}

fn digest(bytes: &[u8]) -> String {
    let mut hasher = SipHasher13::new();
    hasher.write(bytes);
    format!("{:032x}", hasher.finish128().as_u128())
}

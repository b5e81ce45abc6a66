//! A Slurm cluster of two nodes on this machine, for as long as a test takes: real daemons with a key and a configuration of their
//! own in a temporary folder.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Read};
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Whether its programs are here and may be started: the daemons of nodes ask for root.
///
/// # Errors
/// With what is missing.
pub fn available() -> Result<(), String> {
    for program in ["munged", "slurmctld", "slurmd", "sbatch"] {
        let folders = std::env::var_os("PATH").unwrap_or_default();
        let mut folders = std::env::split_paths(&folders).chain(["/usr/sbin".into()]);
        if !folders.any(|folder| folder.join(program).is_file()) {
            return Err(format!("{program} is not installed"));
        }
    }
    let status = fs::read_to_string("/proc/self/status").map_err(|e| e.to_string())?;
    let root = status.lines().any(|line| line.starts_with("Uid:\t0\t"));
    root.then_some(())
        .ok_or_else(|| "slurmd can be started by root only".to_owned())
}

/// Names of the nodes.
pub const NODES: [&str; 2] = ["one", "two"];

/// The daemons; stopped when it is dropped.
#[derive(Debug)]
pub struct Cluster {
    folder: TempDir,
    /// Of the controller and the keeper of keys.
    daemons: Vec<Child>,
    nodes: BTreeMap<&'static str, Child>,
}

impl Drop for Cluster {
    fn drop(&mut self) {
        for node in NODES {
            self.lose(node);
        }
        for daemon in &mut self.daemons {
            let _ended = daemon.kill();
            let _status = daemon.wait();
        }
    }
}

impl Cluster {
    /// Starts the daemons and waits until both nodes are idle.
    ///
    /// # Errors
    /// Of files and processes; and with the logs, where the nodes do not come up.
    pub fn start() -> io::Result<Self> {
        let mut cluster = Self {
            folder: TempDir::with_prefix("slurm-")?,
            daemons: Vec::new(),
            nodes: BTreeMap::new(),
        };
        cluster.write_key()?;
        cluster.write_config()?;
        let munge = |what: &str| format!("--{what}={}", cluster.munge(what).display());
        let mut munged = daemon("munged");
        munged.args(["--foreground", "--force"]);
        munged.args(["key-file", "socket", "pid-file", "log-file", "seed-file"].map(munge));
        cluster.daemons.push(munged.spawn()?);
        cluster.wait_for("munged", || cluster.munge("socket").exists())?;
        let mut controller = daemon("slurmctld");
        controller.arg("-D").arg("-f").arg(cluster.config());
        cluster.daemons.push(controller.spawn()?);
        for node in NODES {
            let mut slurmd = daemon("slurmd");
            slurmd.args(["-D", "-N", node, "-f"]).arg(cluster.config());
            cluster.nodes.insert(node, slurmd.spawn()?);
        }
        cluster.wait_for("the nodes", || {
            let mut sinfo = cluster.command("sinfo");
            sinfo.args(["--noheader", "--Node", "--format=%t"]);
            let answer = sinfo.output().map(|o| o.stdout).unwrap_or_default();
            answer == b"idle\nidle\n"
        })?;
        Ok(cluster)
    }

    /// A program of Slurm's for this cluster.
    pub fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.config());
        command
    }

    /// Stops a node and who keeps the jobs on it, so that nothing there begins or is told to have ended; or lets them go on.
    pub fn freeze(&self, node: &str, frozen: bool) {
        let Some(slurmd) = self.nodes.get(node) else {
            return;
        };
        let signal = if frozen { "-STOP" } else { "-CONT" };
        let all = std::iter::once(slurmd.id()).chain(self.processes_on(node));
        let _sent = (Command::new("kill").arg(signal))
            .args(all.map(|process| process.to_string()))
            .output();
    }

    /// Takes a node away with all that runs on it, as a lost power supply does.
    pub fn lose(&mut self, node: &'static str) {
        let Some(mut slurmd) = self.nodes.remove(node) else {
            return;
        };
        // Who keeps a job must be gone before he can tell of the end of the job.
        let processes = self.processes_on(node);
        let _ended = slurmd.kill();
        let _gone = (Command::new("kill").arg("-9"))
            .args(processes.iter().map(u32::to_string))
            .output();
        let _status = slurmd.wait();
    }

    /// Who keeps the jobs of a node, children of nobody, and all below them.
    fn processes_on(&self, node: &str) -> Vec<u32> {
        let mut squeue = self.command("squeue");
        squeue
            .args(["--noheader", "--states=running", "--format=%A"])
            .arg(format!("--nodelist={node}"));
        let jobs = squeue.output().map(|o| o.stdout).unwrap_or_default();
        let jobs = String::from_utf8_lossy(&jobs);
        let keepers = (jobs.split_whitespace()).map(|job| format!("slurmstepd: [{job}."));
        with_descendants(&keepers.collect::<Vec<_>>())
    }

    fn config(&self) -> PathBuf {
        self.folder.path().join("slurm.conf")
    }

    fn munge(&self, what: &str) -> PathBuf {
        self.folder.path().join("munge").join(what)
    }

    /// Its folder and its key must be nobody else's.
    fn write_key(&self) -> io::Result<()> {
        let key = self.munge("key-file");
        let folder = self.folder.path().join("munge");
        fs::create_dir(&folder)?;
        fs::set_permissions(&folder, fs::Permissions::from_mode(0o700))?;
        let mut random = [0; 1024];
        fs::File::open("/dev/urandom")?.read_exact(&mut random)?;
        fs::write(&key, random)?;
        fs::set_permissions(&key, fs::Permissions::from_mode(0o400))
    }

    fn write_config(&self) -> io::Result<()> {
        let host = fs::read_to_string("/proc/sys/kernel/hostname")?;
        let host = host.trim().split('.').next().unwrap_or("localhost");
        let folder = self.folder.path().display();
        let [controller, first, second] = free_ports()?;
        let socket = self.munge("socket");
        // A node that is silent for ten seconds is down, and its jobs are queued again when their credentials have expired.
        let text = format!(
            "ClusterName=test\n\
            SlurmctldHost={host}(127.0.0.1)\n\
            SlurmctldPort={controller}\n\
            AuthType=auth/munge\nAuthInfo=socket={socket},cred_expire=5\nCredType=cred/munge\n\
            SlurmUser=root\nSlurmdUser=root\n\
            StateSaveLocation={folder}/state\nSlurmdSpoolDir={folder}/spool.%n\n\
            SlurmctldPidFile={folder}/controller.pid\nSlurmdPidFile={folder}/%n.pid\n\
            SlurmctldLogFile={folder}/controller.log\nSlurmdLogFile={folder}/%n.log\n\
            ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nMpiDefault=none\n\
            JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n\
            SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\n\
            SlurmdTimeout=10\nKillWait=2\n\
            SchedulerParameters=sched_interval=1,batch_sched_delay=0\n\
            NodeName=one NodeHostname={host} NodeAddr=127.0.0.1 Port={first} CPUs=1 RealMemory=1\n\
            NodeName=two NodeHostname={host} NodeAddr=127.0.0.1 Port={second} CPUs=1 RealMemory=1\n\
            PartitionName=all Nodes=one,two Default=YES State=UP\n",
            socket = socket.display(),
        );
        fs::create_dir(self.folder.path().join("state"))?;
        fs::write(self.config(), text)
    }

    /// Waits for half a minute at most.
    fn wait_for(&self, what: &str, ready: impl Fn() -> bool) -> io::Result<()> {
        let until = Instant::now() + Duration::from_secs(30);
        while !ready() {
            if Instant::now() > until {
                return Err(io::Error::other(format!(
                    "{what} did not come up:\n{}",
                    self.logs()
                )));
            }
            std::thread::sleep(Duration::from_millis(100));
        }
        Ok(())
    }

    /// What the daemons have logged.
    pub fn logs(&self) -> String {
        ["munge/log-file", "controller.log", "one.log", "two.log"]
            .map(|name| fs::read_to_string(self.folder.path().join(name)).unwrap_or_default())
            .join("\n")
    }
}

/// A program that may be where only root looks.
fn daemon(name: &str) -> Command {
    let there = Path::new("/usr/sbin").join(name);
    let mut command = if there.is_file() {
        Command::new(there)
    } else {
        Command::new(name)
    };
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
}

/// Ports that nobody listens to now.
fn free_ports() -> io::Result<[u16; 3]> {
    let listeners = [(); 3].map(|()| TcpListener::bind("127.0.0.1:0"));
    let mut ports = [0; 3];
    for (port, listener) in ports.iter_mut().zip(listeners) {
        *port = listener?.local_addr()?.port();
    }
    Ok(ports)
}

/// Processes whose command line begins with one of these, and all below them, parents first.
fn with_descendants(names: &[String]) -> Vec<u32> {
    let (mut found, mut parents) = (Vec::new(), Vec::new());
    for entry in fs::read_dir("/proc").into_iter().flatten().flatten() {
        let name = entry.file_name();
        let Some(process) = name.to_str().and_then(|n| n.parse::<u32>().ok()) else {
            continue;
        };
        let read = |file: &str| fs::read_to_string(entry.path().join(file)).unwrap_or_default();
        let line = read("cmdline");
        if names.iter().any(|name| line.starts_with(name)) {
            found.push(process);
        }
        // Behind the name, which is in brackets and may hold anything: state and parent.
        let stat = read("stat");
        let mut after = stat.rsplit(')').next().unwrap_or("").split_whitespace();
        parents.extend(
            after
                .nth(1)
                .and_then(|parent| Some((process, parent.parse::<u32>().ok()?))),
        );
    }
    let mut at = 0;
    while at < found.len() {
        let of = found[at];
        found.extend(
            parents
                .iter()
                .filter(|(_, parent)| *parent == of)
                .map(|(process, _)| *process),
        );
        at += 1;
    }
    found
}

#!/usr/bin/env python3
"""A stand-in for OpenPBS (PBS Pro 20 and later) for tests: one server and the commands qsub, qstat, qdel, qhold, qrls.

    pbs_stand_in.py start --dir DIR --nodes N --slots S [--kill-delay 10] [--down-delay 4] [--max-queued 0]
    pbs_stand_in.py node-kill NODE | node-start NODE | ctl-stop | ctl-start | stop     (each with --dir DIR)

DIR/bin then holds the commands; they find the server by the environment variable PBS_STAND_IN_DIR. The server runs
jobs as processes of this machine, each in a session of its own; it ends by itself when DIR vanishes.
Files in DIR/state that make it misbehave while they exist: qsub_rubbish, qsub_hangs, qsub_no_job, qstat_fails;
no_history (finished jobs are forgotten, PBS's default), comment (its text is what waiting jobs give as their reason),
show_state (lines «ID LETTER»: what qstat shows instead of the state, for S, T, W, ...).

Where the behaviour is from (github.com/openpbs/openpbs, commit cd7ab5ed): src/cmds/qstat.c for all its forms,
src/cmds/qsub.c, qdel.c and src/include/pbs_error.h for words and exit codes (a code's lowest eight bits),
src/lib/Liblog/pbs_messages.c for the server's words, src/lib/Libattr/master_job_attr_def.xml and
src/include/pbs_ifl.h for names and order of attributes, src/server/req_delete.c, req_holdjob.c, node_manager.c and
src/resmom/requests.c, mom_main.c, start_exec.c for what happens to jobs.
"""
from __future__ import annotations
import argparse, getopt, json, os, re, select, shlex, shutil, signal, socket, subprocess, sys, time
from pathlib import Path

SERVER, HOST = "pbs", os.uname().nodename
# pbs_messages.c and pbs_error.h: what the server says, and its number.
UNKNOWN_JOB, INVALID, BAD_STATE = ("Unknown Job Id", 15001), ("Invalid request", 15004), ("Request invalid for state of job", 15016)
FINISHED, FINISHED_TASK = ("Job has finished", 15139), ("Request invalid for finished array subjob", 15159)
UNKNOWN_QUEUE, TOO_BIG = ("Unknown queue", 15018), ("Job violates queue and/or server resource limits", 15036)
MANY_QUEUED = ("would exceed complex's per-user limit of jobs in 'Q' state", 15142)
KNOWN_RESOURCES = "ncpus mem walltime cput vmem pmem host vnode arch ngpus mpiprocs ompthreads select place".split()


def fail(words: str, code: int = 1) -> None:
    print(words, file=sys.stderr)
    sys.exit(code & 255)


def clock(seconds: float) -> str:
    return "%02d:%02d:%02d" % (seconds // 3600, seconds // 60 % 60, seconds % 60)


def session_processes(*sessions: int) -> list[int]:
    """Everything that lives in sessions: PBS signals sessions, not only process groups (mom_mach.c kill_session)."""
    found = []
    for entry in os.listdir("/proc"):
        try:
            fields = Path("/proc", entry, "stat").read_text().rpartition(")")[2].split() if entry.isdigit() else []
        except OSError:
            continue
        if len(fields) > 3 and int(fields[3]) in sessions and fields[0] != "Z":
            found.append(int(entry))
    return found


def signal_all(processes: list[int], number: int) -> bool:
    for pid in processes:
        try:
            os.kill(pid, number)
        except ProcessLookupError:
            pass
    return bool(processes)


class Job:
    """A job or one task (subjob) of an array; `spec` is what qsub sent, shared by all tasks of an array."""

    def __init__(self, number: int, index: int | None, spec: dict) -> None:
        self.number, self.index, self.spec = number, index, spec
        self.id = f"{number}.{SERVER}" if index is None else f"{number}[{index}].{SERVER}"
        self.state, self.comment, self.node, self.slot = "Q", "", "", 0
        self.process: subprocess.Popen | None = None
        self.runs, self.started, self.kill_at, self.leave_at, self.exit = 0, 0.0, 0.0, 0.0, 0

    def signal(self, number: int) -> None:
        signal_all(session_processes(self.process.pid) if self.process else [], number)


class Server:
    def __init__(self, options: argparse.Namespace) -> None:
        self.options, self.state = options, Path(options.dir, "state")
        os.chdir(self.state)  # sockets are opened by short relative names: a long DIR would not fit into an address
        self.nodes = {f"node{i + 1}": True for i in range(options.nodes)}
        self.jobs: list[Job] = []
        self.parents: dict[int, Job] = {}
        self.number, self.running = 0, True
        self.control, self.public = self.listen("control"), self.listen("server")

    @staticmethod
    def listen(name: str) -> socket.socket:
        listener = socket.socket(socket.AF_UNIX)
        listener.bind(name)
        listener.listen(1024)
        return listener

    def serve(self) -> None:
        signal.signal(signal.SIGTERM, lambda *_: setattr(self, "running", False))
        looked = 0.0
        while self.running and self.state.is_dir():
            for listener in select.select([s for s in (self.control, self.public) if s], [], [], 0.1)[0]:
                try:
                    link = listener.accept()[0]
                    link.settimeout(5)
                    request = json.loads(link.makefile().readline())
                    reply = getattr(self, "do_" + request.pop("do"))(**request)
                    link.sendall(json.dumps(reply).encode() + b"\n")
                    link.close()
                except (OSError, ValueError):
                    pass  # a client that went away
            if time.monotonic() >= looked + 0.1:
                self.look_after_jobs()
                looked = time.monotonic()
        sessions = {job.process.pid for job in self.jobs if job.process and job.state == "R"}
        while signal_all(session_processes(*sessions), signal.SIGKILL):
            time.sleep(0.02)
        (self.state / "stopped").touch() if self.state.is_dir() else None

    def look_after_jobs(self) -> None:
        now = time.time()
        for job in [j for j in self.jobs if j.process and j.state == "R"]:
            lost = not self.nodes[job.node]
            if job.kill_at and now >= job.kill_at and not lost:
                job.signal(signal.SIGKILL)
            elif job.spec["walltime"] and not job.kill_at and now >= job.started + job.spec["walltime"]:
                job.signal(signal.SIGTERM)  # requests.c terminate_job: SIGTERM, SIGKILL after kill_delay
                job.kill_at = now + self.options.kill_delay
            code = job.process.poll()
            if code is None or lost and now < job.leave_at:
                continue  # as long as the server waits for a lost node, its jobs are shown as running
            # mom_start.c: a job that was told to end lives on while anything of its session does; others are cleaned.
            if job.kill_at and now < job.kill_at and session_processes(job.process.pid):
                continue
            if not lost:
                job.signal(signal.SIGKILL)
            if lost and job.spec["rerunnable"] and self.public:  # node_manager.c node_down_requeue
                job.state, job.process, job.node, job.kill_at, job.comment = "Q", None, "", 0.0, ""
            else:
                job.state, job.exit, job.leave_at = "E", (256 - code if code < 0 else code), 0 if lost else now + 0.3
        if not self.public:
            return  # without the server nothing starts and nothing is forgotten
        for job in [j for j in self.jobs if j.state == "E" and now >= j.leave_at]:
            self.finish(job)
        free = {node: self.options.slots if up else 0 for node, up in self.nodes.items()}
        for job in [j for j in self.jobs if j.node and j.state in "RE"]:
            free[job.node] -= job.spec["ncpus"]
        for job in [j for j in self.jobs if j.state == "Q" and not self.held(j)]:
            self.schedule(job, now, free)

    def held(self, job: Job) -> bool:
        return self.parents.get(job.number, job).spec["hold"]

    def finish(self, job: Job) -> None:
        job.state = "F" if job.index is None else "X"  # a task stays visible as expired while its array lives
        job.comment = "Subjob finished" if job.index is not None else job.comment + " and finished"
        tasks = [j for j in self.jobs if j.number == job.number]
        if all(j.state in "FX" for j in tasks):
            for task in tasks:
                task.state = "F"
            if Path("no_history").exists():
                self.jobs = [j for j in self.jobs if j.number != job.number]

    def schedule(self, job: Job, now: float, free: dict[str, int]) -> None:
        wanted, host = job.spec["ncpus"], job.spec["host"]
        nodes = [n for n in self.nodes if host in ("", n)]
        for node in nodes:
            if free[node] >= wanted:
                free[node] -= wanted
                return self.run(job, node, now, self.options.slots - free[node] - wanted)
        # scheduler/job_info.cpp and check.cpp: why a job waits, or can never start
        most = max([0, *(free[n] for n in nodes)])
        never = wanted > self.options.slots or not nodes
        amount = f"Insufficient amount of resource: ncpus (R: {wanted} A: {most} T: {self.options.slots})"
        if not nodes:
            amount = f"Insufficient amount of resource: host ({host} != {','.join(self.nodes)})"
        comment = ("Can Never Run: " if never else "Not Running: ") + amount
        job.comment = Path("comment").read_text().strip() if Path("comment").exists() else comment

    def run(self, job: Job, node: str, now: float, slot: int) -> None:
        spec, home = job.spec, os.path.expanduser("~")
        (self.state / "jobs").mkdir(exist_ok=True)
        script, node_file = self.state / "jobs" / f"{job.id}.SC", self.state / "jobs" / f"{job.id}.nodes"
        script.write_text(spec["script"])
        script.chmod(0o700)
        node_file.write_text(node + "\n")
        # start_exec.c: jobs begin in the home directory with a small environment of their own and that of -v.
        environment = {"HOME": home, "USER": spec["user"], "LOGNAME": spec["user"], "SHELL": "/bin/bash",
                       "PATH": f"{self.options.dir}/bin:/usr/local/bin:/usr/bin:/bin", "PBS_STAND_IN_DIR": self.options.dir}
        environment.update(dict(spec["variables"]))
        environment.update(PBS_JOBID=job.id, PBS_JOBNAME=spec["name"], PBS_QUEUE=spec["queue"], PBS_ENVIRONMENT="PBS_BATCH",
                           PBS_NODEFILE=str(node_file), PBS_JOBDIR=home, NCPUS=str(spec["ncpus"]),
                           OMP_NUM_THREADS=str(spec["ncpus"]), PBS_STAND_IN_NODE=node)
        if job.index is not None:
            environment.update(PBS_ARRAY_INDEX=str(job.index), PBS_ARRAY_ID=f"{job.number}[].{SERVER}")
        suffix = "" if job.index is None else f".{job.index}"
        def sink(kind: str):
            path = spec[kind].rpartition(":")[2] or f"{spec['name']}.{kind}{job.number}{suffix}"
            return open(Path(spec["cwd"], path.replace("^array_index^", str(job.index))), "ab")
        try:
            with sink("o") as out, sink("o" if spec["join"] else "e") as err:
                # The shell gets the script's name on its standard input, brackets escaped, as in start_exec.c.
                job.process = subprocess.Popen(["/bin/bash"], stdin=subprocess.PIPE, stdout=out, stderr=err, cwd=home,
                                               env=environment, start_new_session=True)
        except OSError as error:
            self.parents.get(job.number, job).spec["hold"] = True
            job.comment = f"job held, too many failed attempts to run ({error})"
            return
        job.process.stdin.write(re.sub(r"([^\w/.-])", r"\\\1", str(script)).encode() + b"\n")
        job.process.stdin.close()
        job.state, job.node, job.slot, job.started, job.runs, job.kill_at = "R", node, slot, now, job.runs + 1, 0.0
        job.comment = time.strftime("Job run at %a %b %d at %H:%M", time.localtime(now)) + f" on ({node}:ncpus={spec['ncpus']})"

    # What the commands ask for. Each answers with something that JSON can carry.
    def do_ping(self) -> bool:
        return True

    def do_stop(self) -> bool:
        self.running = False
        return True

    def do_ctl(self, away: bool) -> bool:
        if self.public and away:
            self.public.close()
            os.unlink("server")
        self.public = None if away else self.public or self.listen("server")
        return True

    def do_node(self, node: str, dead: bool) -> bool:
        for job in [j for j in self.jobs if j.node == node and j.state == "R" and self.nodes[node] == dead]:
            job.leave_at = time.time() + self.options.down_delay if dead else 0.0
            job.signal(signal.SIGKILL)
        self.nodes[node] = self.nodes[node] and not dead
        self.look_after_jobs()
        self.nodes[node] = not dead
        return True

    def do_qsub(self, spec: dict) -> dict:
        indices = spec["indices"] or [None]
        waiting = sum(j.state == "Q" for j in self.jobs)
        for wrong, (words, code) in ((spec["queue"] not in ("workq", "long"), UNKNOWN_QUEUE),
                                     (spec["ncpus"] > self.options.nodes * self.options.slots, TOO_BIG),
                                     (0 < self.options.max_queued < waiting + len(indices), MANY_QUEUED)):
            if wrong:
                return {"error": words, "code": code}
        self.number += 1
        job_id = f"{self.number}[].{SERVER}" if spec["indices"] else f"{self.number}.{SERVER}"
        if not spec["no_job"]:
            self.jobs += [Job(self.number, index, dict(spec)) for index in indices]
            if spec["indices"]:
                self.parents[self.number] = Job(self.number, None, spec)
                self.parents[self.number].id = job_id
        return {"id": job_id}

    def find(self, job_id: str) -> tuple[list[Job], str]:
        """The jobs an id means (all tasks for an array's), and what kind of id it is: job, task or array."""
        match = re.fullmatch(r"(\d+)(\[(\d*)\])?(\..*)?", job_id)
        if not match:
            return [], "job"
        index = int(match[3]) if match[3] else None
        kind = "job" if not match[2] else "array" if index is None else "task"
        found = [j for j in self.jobs if j.number == int(match[1]) and (kind == "array" or j.index == index)]
        return ([] if kind == "array" and found and found[0].index is None else found), kind

    def do_change(self, what: str, ids: list[str], user: str) -> dict:
        answers, told = [], []
        for job_id in ids:
            jobs, kind = self.find(job_id)
            live = [j for j in jobs if j.state not in "FX"]
            full = job_id if "." in job_id else f"{job_id}.{SERVER}"
            problem = None
            if not jobs:
                problem = UNKNOWN_JOB
            elif not live:
                problem = FINISHED_TASK if jobs[0].state == "X" and kind == "task" else FINISHED
            elif what == "qdel" and kind != "array" and live[0].state == "E":
                problem = BAD_STATE
            elif what != "qdel" and kind == "task":
                problem = INVALID  # req_holdjob.c: only whole arrays can be held
            elif what != "qdel":
                self.parents.get(jobs[0].number, jobs[0]).spec["hold"] = what == "qhold"
            for job in live if what == "qdel" and not problem else []:
                if job.state == "R":
                    if not job.kill_at:
                        told.append(job.process.pid)
                        job.kill_at = time.time() + self.options.kill_delay
                    if "terminated" not in job.comment:  # svr_jobfunc.c update_job_finish_comment
                        job.comment += f" and terminated by {user}@{HOST}"
                elif job.state != "E":
                    self.finish(job)
            answers.append([full, *(problem or ("", 0))])
        signal_all(session_processes(*told), signal.SIGTERM)
        return {"answers": answers}

    def do_qstat(self, ids: list[str], tasks: bool, history: bool) -> dict:
        chosen: list[Job] = []
        errors = []
        for job_id in ids or [""]:
            jobs, kind = (self.jobs, "") if not job_id else self.find(job_id)
            full = job_id if "." in job_id else f"{job_id}.{SERVER}"
            over = bool(jobs) and all(j.state == "F" for j in jobs)
            if job_id and (not jobs or over and not history):
                errors.append([full, *(FINISHED if over else UNKNOWN_JOB)])
                continue
            for job in jobs:
                parent = self.parents.get(job.number)
                if job.state == "F" and not history:
                    continue
                if parent and kind != "task" and parent not in chosen:
                    chosen.append(parent)
                if not parent or tasks or kind == "task":
                    chosen.append(job)
        path = Path("show_state")
        forced = dict(line.split() for line in path.read_text().splitlines()) if path.exists() else {}
        return {"jobs": [[job.id, self.attributes(job, forced)] for job in chosen], "errors": errors}

    def attributes(self, job: Job, forced: dict) -> dict:
        """Names and order as in master_job_attr_def.xml; resources as NAME.RESOURCE."""
        spec, parent = job.spec, self.parents.get(job.number)
        tasks = [j for j in self.jobs if j.number == job.number] if job is parent else []
        state, comment, hold = job.state, job.comment, self.held(job)
        if job is parent:
            begun = any(j.state not in "QF" or j.runs for j in tasks)
            state = "F" if all(j.state == "F" for j in tasks) else "H" if hold and not begun else "B" if begun else "Q"
            comment = next((j.comment for j in tasks if j.state == "Q"), "") if state == "Q" else "Job Array Began"
        elif state == "Q" and hold and not parent:
            state = "H"  # tasks of a held array are shown as Q; only Hold_Types tells (stat_job.c status_subjob)
        date = lambda when: time.strftime("%a %b %e %H:%M:%S %Y", time.localtime(when))
        a = {"Job_Name": spec["name"], "Job_Owner": f"{spec['user']}@{HOST}"}
        if job.started:
            a.update({"resources_used.cput": "00:00:00", "resources_used.ncpus": spec["ncpus"],
                      "resources_used.walltime": clock(time.time() - job.started)})
        a.update({"job_state": forced.get(job.id, state), "queue": spec["queue"], "server": SERVER})
        a.update({"Account_Name": spec["account"]} if spec["account"] else {})
        a.update({"Checkpoint": "u", "ctime": date(spec["ctime"]), "Error_Path": f"{HOST}:{spec['e'] or spec['cwd'] + '/'}"})
        if job.node and state in "REFS":  # exec_host: NODE/SLOT, with *CPUS when it is more than one
            a["exec_host"] = f"{job.node}/{job.slot}" + (f"*{spec['ncpus']}" if spec["ncpus"] > 1 else "")
            a["exec_vnode"] = f"({job.node}:ncpus={spec['ncpus']})"
        a.update({"Hold_Types": "u" if hold else "n", "Join_Path": "oe" if spec["join"] else "n", "Keep_Files": "n",
                  "Mail_Points": spec["mail"], "mtime": date(job.started or spec["ctime"]),
                  "Output_Path": f"{HOST}:{spec['o'] or spec['cwd'] + '/'}", "Priority": 0, "qtime": date(spec["ctime"]),
                  "Rerunable": "True" if spec["rerunnable"] else "False"})
        a.update({"Resource_List.mem": spec["mem"]} if spec["mem"] else {})
        a.update({"Resource_List.ncpus": spec["ncpus"], "Resource_List.nodect": 1, "Resource_List.place": "pack"})
        a["Resource_List.select"] = f"1:ncpus={spec['ncpus']}" + (f":mem={spec['mem']}" if spec["mem"] else "")
        a.update({"Resource_List.walltime": clock(spec["walltime"])} if spec["walltime"] else {})
        a.update({"stime": date(job.started), "session_id": job.process.pid} if job.process else {})
        a["substate"] = {"Q": 10, "H": 20, "R": 42, "E": 51, "B": 70}.get(state, 92)
        escape = lambda value: re.sub(r"([\\,\"'])", r"\\\1", value)
        a["Variable_List"] = ",".join(f"{n}={escape(v)}" for n, v in spec["variables"])
        a.update({"comment": comment} if comment else {})
        a.update({"etime": date(spec["ctime"])})
        a.update({"run_count": job.runs} if job.runs else {})
        a.update({"Exit_status": job.exit} if state in "FX" and job.started else {})
        a.update({"Submit_arguments": spec["arguments"]} if spec["arguments"] else {})
        if job is parent:
            left = [j.index for j in tasks if j.state == "Q"]
            count = lambda letters: sum(j.state in letters for j in tasks)
            a.update({"array": "True", "array_state_count": f"Queued:{count('Q')} Running:{count('R')} Exiting:{count('E')} "
                      f"Expired:{count('XF')} ", "array_indices_submitted": spec["range"],
                      "array_indices_remaining": f"{left[0]}-{left[-1]}" if left else "-"})
        elif parent and job.runs:  # tasks that never started are made up from their array: without these two
            a.update({"array_id": parent.id, "array_index": job.index})
        a.update({"project": "_pbs_project_default", "Submit_Host": HOST})
        return a


def call(where: Path, request: dict, name: str = "server") -> dict:
    """Asks the server; without one, what PBS's commands say and how they end (PBSE_SYSTEM is 15010)."""
    back = os.getcwd()
    try:
        os.chdir(where / "state")
        with socket.socket(socket.AF_UNIX) as link:
            link.connect(name)
            link.settimeout(30)
            os.chdir(back)
            link.sendall(json.dumps(request).encode() + b"\n")
            return json.loads(link.makefile().readline())
    except (OSError, ValueError):
        program = os.path.basename(sys.argv[0])
        if program == "qdel":  # qdel.c delete_jobs_for_cluster
            fail(f"Connection refused\nCouldn't connect to cluster: {SERVER}", 15010)
        fail(f"Connection refused\n{program}: cannot connect to server {SERVER} (errno=15010)", 255 if program == "qstat" else 15010)
    return {}


# ---- qsub ----------------------------------------------------------------------------------------------------------
QSUB_OPTIONS = "a:A:c:C:e:fGhIj:J:k:l:m:M:N:o:p:P:q:r:R:S:u:v:VW:Xz"
usage = "usage: qsub [-a date_time] [-A account_string] [-c interval] ..."


def seconds(text: str) -> int:
    total = 0
    for part in text.split(":"):
        total = total * 60 + int(part)
    return total


def qsub(where: Path, arguments: list[str]) -> None:
    if (where / "state/qsub_hangs").exists():
        time.sleep(60)
    given, seen, fixed = {}, {}, set()

    def take(words: list[str], code: int) -> list[str]:
        """The command line comes first and wins over the script, except that all -l count."""
        try:
            options, rest = getopt.getopt(words, QSUB_OPTIONS)
        except getopt.GetoptError as error:
            fail(f"qsub: invalid option -- '{error.opt}'\n{usage}", 2)
        new: dict = {}
        for option, value in options:
            if option == "-r" and value not in ("y", "n"):
                fail(f"qsub: illegal -r value\n{usage}", code)
            seen[option] = value if option not in seen else seen[option]
            if seen.get("-r") == "n" and "-J" in seen:
                fail(f"qsub:  cannot submit non-rerunable Array Job\n{usage}", code)  # qsub.c NO_RERUN_ARRAY
            if option == "-l":
                for item in value.split(","):
                    name, _, amount = item.partition("=")
                    given.setdefault("resources", {}).setdefault(name, amount)
            else:
                new[option] = value
        for option, value in new.items():  # within the script the last one counts, whole lists of -v too
            if option not in fixed:
                given[option] = value
        return rest

    rest = take(arguments, 2)
    fixed.update(given)
    script = sys.stdin.read() if not rest or rest[0] == "-" else Path(rest[0]).read_text()
    for line in script.splitlines():  # directives count until the first line that is a command
        if line.startswith("#PBS"):
            take(shlex.split(line[4:]), 1)
        elif line.strip() and not line.lstrip().startswith("#"):
            break
    if (where / "state/qsub_rubbish").exists():
        print("%$& this is not an id")
        return
    name = given.get("-N", "STDIN" if not rest or rest[0] == "-" else os.path.basename(rest[0]))
    if len(name) > 230:  # PBS_MAXJOBNAME in pbs_ifl.h, ck_job_name.c
        fail("qsub: Job name is too long ", 2)
    if not re.fullmatch(r"[A-Za-z0-9_+.-]+", name):
        fail(f"qsub: illegal -N value\n{usage}", 2)
    indices = None
    if "-J" in given:  # chk_Jrange.c: X-Y[:Z], X smaller than Y
        match = re.fullmatch(r"(\d+)-(\d+)(?::(\d+))?", given["-J"].partition("%")[0])
        if not match or int(match[1]) >= int(match[2]) or match[3] == "0":
            fail(f"qsub: illegal -J value\n{usage}", 2)
        indices = list(range(int(match[1]), int(match[2]) + 1, int(match[3] or 1)))
    resources = dict(given.get("resources", {}))
    chunk = dict(item.partition("=")[::2] for item in resources.get("select", "").split(":")[1:])
    for resource in [*resources, *chunk]:
        if resource not in KNOWN_RESOURCES:
            fail(f"qsub: Unknown resource: {resource}", 15035)
    for resource in ("ncpus", "mem", "host"):
        if "select" in resources and resource in resources:  # vnparse.c, PBSE_INVALJOBRESC
            fail(f'qsub: "-lresource=" cannot be used with "select" or "place", resource is: {resource}', 15109)
    resources.update(chunk)
    memory = re.fullmatch(r"(?i)(\d+)([kmgtp]?)b?", resources.get("mem", "1"))
    try:
        spec = {"ncpus": int(resources.get("ncpus", 1)), "walltime": seconds(resources.get("walltime", "0"))}
    except ValueError:
        memory = None
    if not memory:
        fail("qsub: Illegal attribute or resource value", 15014)
    env, user = os.environ, os.environ.get("USER") or os.environ.get("LOGNAME") or subprocess.getoutput("id -un")
    variables = [["PBS_O_" + n, env[n]] for n in ("HOME", "LANG", "LOGNAME", "PATH", "MAIL", "SHELL", "TZ") if n in env]
    variables += [["PBS_O_WORKDIR", os.getcwd()], ["PBS_O_SYSTEM", "Linux"]]
    for item in re.findall(r"(?:\\.|[^,\\])+", given.get("-v", "")):
        item = re.sub(r"\\(.)", r"\1", item)
        if "=" not in item and item not in env:
            fail("qsub: cannot send environment with the job", 1)
        variables.append([item.partition("=")[0], item.partition("=")[2] if "=" in item else env[item]])
    variables += [[n, v] for n, v in env.items() if "-V" in given and not n.startswith("PBS_O_")]
    variables += [["PBS_O_QUEUE", given.get("-q", "workq")], ["PBS_O_HOST", HOST]]
    spec.update(name=name, script=script, indices=indices, range=given.get("-J", ""), user=user, cwd=os.getcwd(),
                mem=f"{memory[1]}{memory[2].lower()}b" if "mem" in resources else "", host=resources.get("host", ""),
                queue=given.get("-q", "workq"), account=given.get("-A", ""), hold="-h" in given, ctime=time.time(),
                rerunnable=given.get("-r", "y") == "y", join="o" in given.get("-j", ""), o=given.get("-o", ""),
                e=given.get("-e", ""), mail=given.get("-m", "a"), variables=variables, arguments=shlex.join(arguments),
                no_job=(where / "state/qsub_no_job").exists())
    reply = call(where, {"do": "qsub", "spec": spec})
    if "error" in reply:
        fail(f"qsub: {reply['error']}", reply["code"])
    print(reply["id"])


# ---- qstat ---------------------------------------------------------------------------------------------------------
def folded(name: str, value: str) -> str:
    """One attribute of `qstat -f` (qstat.c prt_attr): broken at commas where possible, else anywhere; a tab follows.
    Commas are not counted, so that lines can be a little too long; commas that follow each other become one."""
    text, column = f"    {name} = ", len(name) + 7
    for position, part in enumerate(filter(None, value.split(","))):
        text += "," if position else ""
        if column + len(part) < 78:
            text, column = text + part, column + len(part)
            continue
        if position:
            text, column = text + "\n\t", 9
        for letter in part:
            text, column = text + letter, column + 1
            if column > 78:
                text, column = text + "\n\t", 8
    return text + "\n"


def cut(text: object, width: int) -> str:
    return str(text) if len(str(text)) <= width else str(text)[: width - 1] + "*"


def qstat(where: Path, arguments: list[str]) -> None:
    if (where / "state/qstat_fails").exists():
        fail("qstat: Batch protocol error", 1)
    try:
        pairs, ids = getopt.gnu_getopt(arguments, "atwxu:fF:")
    except getopt.GetoptError:
        fail("usage: \nqstat [-f] [-t] [-x] [-F format | -w] [-a | -u user] [ job_identifier... ]", 2)
    options = dict(pairs)
    reply = call(where, {"do": "qstat", "ids": ids, "tasks": "-t" in options, "history": "-x" in options})
    jobs = reply["jobs"]
    if "-u" in options:
        users = [u.partition("@")[0] for u in options["-u"].split(",")]
        jobs = [j for j in jobs if j[1]["Job_Owner"].partition("@")[0] in users]
    short = "-u" in options or "-a" in options  # wins over -f
    if "-f" in options and not short and options.get("-F", "").lower() == "json":
        print_json(jobs)
    elif "-f" in options and not short:
        for job_id, attributes in jobs:
            print(f"Job Id: {job_id}")
            for name, value in attributes.items():
                print(f"    {name} = {value}" if "-w" in options else folded(name, str(value))[:-1])
            print()
    elif jobs and short:  # qstat.c altdsp_statjob
        print(f"\n{SERVER}: \n{' ':60s}{'Req' + chr(39) + 'd':7s}{'Req' + chr(39) + 'd':8s}Elap")
        print("Job ID          Username Queue    Jobname    SessID NDS TSK Memory Time  S Time")
        print("--------------- -------- -------- ---------- ------ --- --- ------ ----- - -----")
        for job_id, a in jobs:
            print("%-15.15s %-8.8s %-8.8s %-10.10s %6.6s %3.3s %3.3s %6.6s %5.5s %1.1s %5.5s" % (
                cut(job_id, 15), cut(a["Job_Owner"].partition("@")[0], 8), cut(a["queue"], 8), cut(a["Job_Name"], 10),
                cut(a.get("session_id", " -- "), 6), a["Resource_List.nodect"], a["Resource_List.ncpus"],
                a.get("Resource_List.mem", " -- "), a.get("Resource_List.walltime", " -- "), a["job_state"],
                a.get("resources_used.walltime", " -- ")))
    elif jobs:  # qstat.c display_statjob
        print("Job id            Name             User              Time Use S Queue")
        print("----------------  ---------------- ----------------  -------- - -----")
        for job_id, a in jobs:
            name = a["Job_Name"] if len(a["Job_Name"]) < 16 else a["Job_Name"][:15] + "*"
            print("%-17s %-16s %-16s  %8s %1s %-16s" % (cut(job_id, 17), name, cut(a["Job_Owner"].partition("@")[0], 16),
                                                        a.get("resources_used.cput", "0"), a["job_state"], cut(a["queue"], 16)))
    code = 0
    for job_id, words, code in reply["errors"]:
        late = words == FINISHED[0]
        print(f"qstat: {job_id} {words}, use -x or -H to obtain historical job information" if late
              else f"qstat: {words} {job_id}", file=sys.stderr)
    sys.exit(code & 255)


def print_json(jobs: list) -> None:
    """-F json (qstat.c): resources and variables as objects of their own."""
    listed = {}
    for job_id, attributes in jobs:
        shown = listed.setdefault(job_id, {})
        for name, value in attributes.items():
            first, dot, second = name.partition(".")
            if dot:
                shown.setdefault(first, {})[second] = value
            elif name == "Variable_List":
                shown[name] = dict(re.sub(r"\\(.)", r"\1", v).partition("=")[::2] for v in re.findall(r"(?:\\.|[^,\\])+", value))
            else:
                shown[name] = value
    print(json.dumps({"timestamp": int(time.time()), "pbs_version": "23.06.06", "pbs_server": SERVER,
                      **({"Jobs": listed} if listed else {})}, indent=4))


def change(where: Path, program: str, arguments: list[str]) -> None:
    ids = getopt.getopt(arguments, "W:xh:")[1]
    if not ids:
        fail(f"usage:\n\t{program} job_identifier...", 2)
    user, last = subprocess.getoutput("id -un"), 0
    for job_id, words, code in call(where, {"do": "change", "what": program, "ids": ids, "user": user})["answers"]:
        if code:
            print(f"{program}: {words} {job_id}", file=sys.stderr)
            last = code
    sys.exit(last & 255)


def control() -> None:
    parser = argparse.ArgumentParser(description="A stand-in for PBS; see the beginning of this file.")
    parser.add_argument("action", choices=["start", "stop", "serve", "node-kill", "node-start", "ctl-stop", "ctl-start"])
    parser.add_argument("node", nargs="?")
    parser.add_argument("--dir", default=os.environ.get("PBS_STAND_IN_DIR"))
    for name, default in (("nodes", 2), ("slots", 2), ("kill-delay", 10.0), ("down-delay", 4.0), ("max-queued", 0)):
        parser.add_argument("--" + name, type=type(default), default=default)
    options = parser.parse_args()
    options.dir = os.path.abspath(options.dir)
    where, me = Path(options.dir), Path(__file__).resolve()
    if options.action == "serve":
        Server(options).serve()
    elif options.action == "start":
        shutil.rmtree(where / "state", ignore_errors=True)
        (where / "state").mkdir(parents=True)
        (where / "bin").mkdir(exist_ok=True)
        for name in ("qsub", "qstat", "qdel", "qhold", "qrls"):
            link = where / "bin" / name
            link.unlink() if link.is_symlink() else None
            link.symlink_to(me)
        words = [sys.executable, str(me), "serve"]
        for name in ("dir", "nodes", "slots", "kill_delay", "down_delay", "max_queued"):
            words += ["--" + name.replace("_", "-"), str(getattr(options, name))]
        server = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                  stderr=open(where / "state/log", "ab"), start_new_session=True)
        while not (where / "state/server").exists():
            if server.poll() is not None:
                fail("pbs_stand_in: " + (where / "state/log").read_text())
            time.sleep(0.02)
        call(where, {"do": "ping"}, "control")
        server.returncode = 0  # it is meant to outlive this process
    else:
        what, _, how = options.action.partition("-")
        request = {"ctl": {"away": how == "stop"}, "node": {"node": options.node, "dead": how == "kill"}, "stop": {}}[what]
        call(where, {"do": what, **request}, "control")
        while options.action == "stop" and not (where / "state/stopped").exists() and where.is_dir():
            time.sleep(0.02)


if __name__ == "__main__":
    called = os.path.basename(sys.argv[0])
    directory = Path(os.environ.get("PBS_STAND_IN_DIR", "/nonexistent"))
    if called == "qsub":
        qsub(directory, sys.argv[1:])
    elif called == "qstat":
        qstat(directory, sys.argv[1:])
    elif called in ("qdel", "qhold", "qrls"):
        change(directory, called, sys.argv[1:])
    else:
        control()

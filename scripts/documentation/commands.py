"""Man page and shell completions, made when the program is built from what its own --help says: neither can be out of date."""

import datetime
import os
import re
import subprocess

USAGE = re.compile(r"^  (\w+) (.*?)  +(.*)$", re.MULTILINE)
OPTION = re.compile(r"^  (--[a-z-]+)(?: (.*?))?(?:  +(.*))?$")
KINDS, SCENES = "collision membrane interaction scene", "demo channel suspension capsule red-cell-3d doublet-3d suspension-3d tube-3d"  # of rouleau new
FILES = {"SCENE", "FILE", "DIR", "MANIFEST"}
ENVIRONMENT = {
    "ROULEAU_LAUNCHER": "none: this process is alone, whatever has started it",
    "ROULEAU_PLUGIN_PATH": "folders with plugins, absolute, separated by colons",
    "ROULEAU_SCENE_PLUGINS": "no: folders with plugins that a scene names are left out",
    "XDG_DATA_HOME": "the folder with rouleau/plugins, your own plugins; else ~/.local/share",
    "HOME": "the folder of ~/.local/share, where the variable above is not set",
    "ROULEAU_INSTRUCTION_SET": "baseline, avx2 or avx512: narrower vectors than this processor has, to compare results and speed",
    "ROULEAU_TRANSPORT": "the library through which ranks speak that mpirun or srun has started, in place of the installed one (docs/ranks.md)",
    "ROULEAU_ERRORS": "json: an error is one line of JSON with the place and the remedy of each fault, for programs (docs/python.md)",
    "ROULEAU_TIMING_LOCK": "the file that rouleau study locks while it takes times, so that two studies do not disturb each other",
    "XDG_RUNTIME_DIR": "the folder of that file, rouleau-timing.lock, where the variable above is not set; else /tmp",
    "UDUNITS2_XML_PATH": "the database of units, for UDUNITS-2",
    "COLUMNS": "characters in a line of help, plan, plugins and limits, at most 100, where it is not the terminal's",
    "NO_COLOR": "not empty: no colours on a terminal",
    "TERM": "dumb: no colours on a terminal",
}


def said(program, *arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True, check=True, timeout=60, env={**os.environ, "COLUMNS": "80"}).stdout


class Option:
    def __init__(self, name, value, text):
        self.name, self.value, self.text = name, value, text

    @property
    def kind(self):
        """What a shell completes after it."""
        word = (self.value or "").split(" ")[0]
        return {"SCENE": "json", "FILE": "file", "DIR": "folder"}.get(word, "word" if word else "")


def options_of(help_text):
    found = []
    for line in help_text.split("\noptions:\n")[1].splitlines():
        if match := OPTION.match(line):
            found.append(Option(match[1], match[2], match[3] or ""))
        elif found and line.strip():
            found[-1].text = (found[-1].text + " " + line.strip()).strip()
    return found


def commands_of(program):
    overview = said(program, "--help")
    return [(name, arguments, summary, said(program, name, "--help")) for name, arguments, summary in USAGE.findall(overview)]


def by_place(arguments):
    """What stands in the first place after a command."""
    if "KIND" in arguments:
        return "kind"
    if "ID" in arguments:
        return "id"
    return "folder" if arguments == "DIR" else "json"


def bash(commands):
    names = " ".join(name for name, *_ in commands)
    cases, values = [], set()
    for name, arguments, _, text in commands:
        options = options_of(text)
        cases.append(f'    {name}) options="{" ".join(o.name for o in options)}" place={by_place(arguments)} ;;')
        values |= {(o.name, name, o.kind) for o in options if o.kind}
    takes = "\n".join(f"    {name},{option}) kind={kind} ;;" for option, name, kind in sorted(values))
    return f"""# bash completion of rouleau, made from its --help by scripts/docs
_rouleau() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]-}} options="" place="" kind=""
  COMPREPLY=()
  if [[ $COMP_CWORD -eq 1 ]]; then
    mapfile -t COMPREPLY < <(compgen -W "{names} --help --version" -- "$word")
    return
  fi
  case $command in
{chr(10).join(cases)}
    *) return ;;
  esac
  case $command,$before in
{takes}
  esac
  if [[ -z $kind && $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
    return
  fi
  case ${{kind:-$place}} in
    id) mapfile -t COMPREPLY < <(compgen -W "$("${{COMP_WORDS[0]/#\\~/$HOME}}" plugins --json 2>/dev/null |
          sed -n 's/^ *"id": "\\(.*\\)",*$/\\1/p')" -- "$word") ;;
    kind) [[ $COMP_CWORD -eq 2 ]] && mapfile -t COMPREPLY < <(compgen -W "{KINDS}" -- "$word")
          [[ $COMP_CWORD -eq 3 && ${{COMP_WORDS[2]}} == scene ]] && mapfile -t COMPREPLY < <(compgen -W "{SCENES}" -- "$word") ;;
    folder) compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -d -- "$word") ;;
    file) compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
    json) compopt -o filenames 2>/dev/null
          mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -X '!*.json' -- "$word") ;;
  esac
}}
complete -F _rouleau rouleau
"""


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def zsh(commands):
    actions = {"json": "_files -g \"*.json\"", "file": "_files", "folder": "_files -/", "word": " ",
               "kind": f"({KINDS} {SCENES})", "id": "{_rouleau_ids}"}
    lines = ["#compdef rouleau", "# zsh completion of rouleau, made from its --help by scripts/docs", "_rouleau_ids() {",
             "  local -a ids; ids=(${(f)\"$(rouleau plugins --json 2>/dev/null | sed -n 's/^ *\"id\": \"\\(.*\\)\",*$/\\1/p')\"})",
             "  compadd -a ids", "}", "_rouleau() {", "  if (( CURRENT == 2 )); then", "    local -a commands; commands=("]
    lines += [f"      {quoted(f'{name}:{summary}')}" for name, _, summary, _ in commands]
    lines += ["    )", "    _describe command commands", "    return", "  fi", "  local command=$words[2]",
              "  (( CURRENT-- )); shift words", "  case $command in"]
    for name, arguments, _, text in commands:
        specs = []
        for option in options_of(text):
            about = re.sub(r"[][:]", " ", option.text)
            many = "*" if "(repeatable" in option.text else ""
            action = f":{(option.value or '').split(' ')[0]}:{actions[option.kind]}" if option.kind else ""
            specs.append(quoted(f"{many}{option.name}[{about}]{action}"))
        specs.append(quoted(f"*:argument:{actions[by_place(arguments)]}"))
        lines.append(f"    {name}) _arguments {' '.join(specs)} ;;")
    return "\n".join(lines + ["  esac", "}", '_rouleau "$@"']) + "\n"


def fish(commands):
    lines = ["# fish completion of rouleau, made from its --help by scripts/docs", "complete -c rouleau -f"]
    for name, arguments, summary, text in commands:
        lines.append(f"complete -c rouleau -n __fish_use_subcommand -a {name} -d {quoted(summary)}")
        here = f"-n '__fish_seen_subcommand_from {name}'"
        for option in options_of(text):
            takes = {"": "", "word": " -x", "folder": " -x -a '(__fish_complete_directories)'"}.get(option.kind, " -rF")
            lines.append(f"complete -c rouleau {here} -l {option.name[2:]}{takes} -d {quoted(option.text)}")
        place = by_place(arguments)
        words = {"kind": f"{KINDS} {SCENES}",
                 "id": "(rouleau plugins --json 2>/dev/null | string match -rg \\'^ *\"id\": \"(.*)\"\\')"}
        if place in words:
            lines.append(f"complete -c rouleau {here} -a '{words[place]}'")
        else:
            lines.append(f"complete -c rouleau {here} -F")
    return "\n".join(lines) + "\n"


def roff(text):
    """Text as it stands, safe from roff's own marks."""
    return "\n".join(("\\&" + line if line.startswith((".", "'")) else line)
                     for line in text.replace("\\", "\\e").replace("-", "\\-").splitlines())


def man(program, commands):
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", os.stat(program).st_mtime))
    date = datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).date()
    version = said(program, "--version").split()[1]
    overview = said(program, "--help")
    first = overview.splitlines()[0]
    text = f'.TH ROULEAU 1 "{date}" "rouleau {version}" "User Commands"\n.nh\n.ad l\n'
    text += f".SH NAME\nrouleau \\- {roff(first.removeprefix('Rouleau ').rstrip('.'))}\n.SH SYNOPSIS\n"
    text += "\n.br\n".join(f".B rouleau {name}\n{roff(arguments)} [options]" for name, arguments, *_ in commands) + "\n"
    text += f".SH DESCRIPTION\n{roff(first)} Each command has its own \\-\\-help, which stands here too.\n"
    for name, _, _, help_text in commands:
        text += f".SH ROULEAU {name.upper()}\n.nf\n{roff(help_text.strip())}\n.fi\n"
    text += ".SH ENVIRONMENT\n" + "".join(f".TP\n{name}\n{roff(words)}\n" for name, words in ENVIRONMENT.items())
    text += ".SH FILES\nA run's directory and its files, the scene's keys and all models are explained in share/doc/Rouleau/docs.\n"
    return text


def write(program, out):
    program = program.resolve()
    commands = commands_of(program)
    if not commands:
        raise SystemExit(f"{program} --help lists no commands in the form that scripts/docs reads")
    files = {"rouleau.1": man(program, commands), "bash/rouleau": bash(commands), "zsh/_rouleau": zsh(commands),
             "fish/rouleau.fish": fish(commands)}
    for name, text in files.items():
        path = out / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return 0

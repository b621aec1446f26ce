# Sourced by the other scripts: how far they are, on one line of a terminal, with percent where the
# command's own output tells. Elsewhere (a file, CI) a line at the begin of each step and one every
# half minute. A step that fails shows all that its command wrote; --verbose shows it as it comes.

verbose=false
[ -z "${FIBER_PROXIMITY_VERBOSE-}" ] || verbose=true
# What --verbose does, for this script and those that it calls.
be_verbose() {
  verbose=true
  export FIBER_PROXIMITY_VERBOSE=true
}
progress_interval=${progress_interval-30}  # [s] between lines where there is no terminal

# How far the command is that writes this log, as text; nothing if it does not tell.
#   make:      [ 42%] Building …           ninja, and our own loops: [42/100] …
#   ctest:     42/100 Test …               apt: Get:42, Unpacking …, Setting up …
progress_of() {
  awk '
    match($0, /^\[ *[0-9]+%\]/) { percent = substr($0, 2, RLENGTH - 3); done = "" }
    match($0, /^\[[0-9]+\/[0-9]+\]/) { part(substr($0, 2, RLENGTH - 2)) }
    match($0, /^ *[0-9]+\/[0-9]+ Test/) { part(substr($0, 1, RLENGTH - 5)) }
    / newly installed, / { for (i = 2; i <= NF; ++i) if ($i == "newly") packages = $(i - 1) }
    /^Get:[0-9]+ / && packages { ++got }
    /^Unpacking / { ++unpacked }
    /^Setting up / { ++set_up }
    function part(text, both) {
      gsub(/ /, "", text)
      split(text, both, "/")
      if (both[2] > 0) { percent = int(100 * both[1] / both[2]); done = both[1] " of " both[2] }
    }
    END {
      if (packages) {
        if (set_up > packages) set_up = packages
        percent = int(100 * (got + unpacked + set_up) / (3 * packages))
        if (percent > 100) percent = 100
        if (set_up) done = set_up " of " packages " set up"
        else if (unpacked) done = unpacked " of " packages " unpacked"
        else done = got + 0 " of " packages " fetched"
      }
      if (percent != "") printf "%d %%", percent
      if (done != "") printf " (%s)", done
    }' "$1" 2>/dev/null
}

# say_progress STEP [HOW_FAR] [SECONDS]: on the terminal's line, or as a line if one is due.
progress_step=
progress_due=0
say_progress() {
  local seconds=${3-$SECONDS} line
  line=$(printf '%s ... %d:%02d  %s' "$1" $((seconds / 60)) $((seconds % 60)) "${2-}")
  if [ -t 1 ]; then
    printf '\r\033[K%s' "$line"
  elif [ "$1" != "$progress_step" ] || [ "$SECONDS" -ge "$progress_due" ]; then
    echo "$line"
    progress_step=$1
    progress_due=$((SECONDS + progress_interval))
  fi
}

# Makes room on the terminal's line for what comes next.
end_progress() {
  [ ! -t 1 ] || printf '\r\033[K'
}

# run_step STEP LOG COMMAND...: runs it, showing how far it is; its status is the command's.
run_step() {
  local step=$1 log=$2 status=0 pipe reporter
  shift 2
  if $verbose; then
    echo "$step ..."
    "$@" 2>&1 | tee "$log" || return "${PIPESTATUS[0]}"
    return 0
  fi
  : >"$log"
  # The reporter reads from a pipe that the command does not have: it ends with this script, however that
  # ends. The command is not the one in the background, so that Ctrl-C ends it.
  exec {pipe}> >(report_until_closed "$step" "$log")
  reporter=$!
  (exec {pipe}>&- && "$@") >"$log" 2>&1 || status=$?
  exec {pipe}>&-
  wait "$reporter" || true
  end_progress
  if [ "$status" -ne 0 ]; then
    cat "$log" >&2
  fi
  return "$status"
}

report_until_closed() {
  local start=$SECONDS status
  trap '' INT
  while true; do
    say_progress "$1" "$(progress_of "$2")" $((SECONDS - start))
    status=0
    read -r -t 1 || status=$?
    [ "$status" -gt 128 ] || return 0  # the time was not over: the pipe is closed
  done
}

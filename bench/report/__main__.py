"""Reports of benchmarks, made of the JSON that they write.

  python3 bench/report runtime FOLDER      from all *.json in it, which Google Benchmark wrote
  python3 bench/report meshadapt FOLDER    from results.json of adapt_bench
  python3 bench/report irregular FOLDER    from results.json of irregular_bench
  python3 bench/report many_cores FOLDER THREADS
                                           from what its script left; THREADS is 1,2,4,...; prints a Markdown table

The first three write FOLDER/report.html, one file with tables and plots; without gnuplot it has no plots.
docs/benchmarks*.md say what the tables hold.
"""

import sys
from pathlib import Path

from irregular import report_irregular
from many_cores import report_many_cores
from meshadapt import report_meshadapt
from page import BadFile
from runtime import report_runtime

REPORTS = {"runtime": report_runtime, "meshadapt": report_meshadapt, "irregular": report_irregular,
           "many_cores": report_many_cores}


def main(words):
    if len(words) < 2 or words[0] not in REPORTS or len(words) != (3 if words[0] == "many_cores" else 2):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        REPORTS[words[0]](Path(words[1]), *words[2:])
    except (BadFile, OSError) as error:
        print(f"report: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

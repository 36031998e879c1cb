# Peaks of the wafer's shear from the ensemble's runs, a file for each spacing, then F_tau and its models: of the finest
# spacing, the others held against it member by member. The threshold is that of abrasive_free at the same spacing.
SPACINGS = [f"{spacing:g}" for spacing in load_case("abrasives").data["ensemble"]["spacings"][LEVEL]]
SHOWN = next(run for run in RUNS["abrasives"] if run.variant.name == "shown" and run.finest)
TARGETS += [OUT / "abrasives.md", OUT / "movies/abrasives.gif"]


rule abrasive_peaks:
    input:
        lambda wildcards: [name for name in files("abrasives") if f"/{wildcards.spacing}/" in name],
        OUT / "runs/abrasive_free/default/wafer_moves/{spacing}/run.json",
    output:
        OUT / "abrasives_{spacing}.csv",
    localrule: True
    shell:
        "{PYTHON} -m verification.active_shear --level {LEVEL} --spacing {wildcards.spacing} --out {OUT}"
        " --csv {output}"


rule abrasive_report:
    input:
        others=expand(str(OUT / "abrasives_{spacing}.csv"), spacing=SPACINGS[:-1]),
        finest=OUT / f"abrasives_{SPACINGS[-1]}.csv",
    output:
        csv=OUT / "abrasives.csv",
        json=OUT / "abrasives.json",
        tables=OUT / "abrasives.md",
    localrule: True
    params:
        others=lambda wildcards, input: " ".join(f"--other {name}" for name in input.others),
    shell:
        "cp {input.finest} {output.csv} && {PYTHON} -m verification.abrasive_report --csv {output.csv}"
        " {params.others} --json {output.json} >{output.tables}"


rule abrasive_movie:
    input:
        OUT / f"runs/abrasives/default/shown/{SHOWN.spacing:g}/run.json",
    output:
        OUT / "movies/abrasives.gif",
    localrule: True
    shell:
        "{PYTHON} -m verification.movie $(dirname {input}) --field speed --rate 8 --out {output}"

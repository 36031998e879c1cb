# Peaks of the wafer's shear from the ensemble's runs, then F_tau and its models. The threshold is that of abrasive_free
# at the ensemble's spacing.
ENSEMBLE = load_case("abrasives").data["ensemble"]["spacings"][LEVEL][-1]
FREE = OUT / f"runs/abrasive_free/default/wafer_moves/{ENSEMBLE:g}/run.json"
TARGETS.append(OUT / "abrasives.md")


rule abrasive_peaks:
    input:
        files("abrasives"),
        FREE,
    output:
        OUT / "abrasives.csv",
    shell:
        "{PYTHON} -m verification.active_shear --spacing {ENSEMBLE:g} --out {OUT} --csv {output}"


rule abrasive_report:
    input:
        OUT / "abrasives.csv",
    output:
        json=OUT / "abrasives.json",
        tables=OUT / "abrasives.md",
    shell:
        "{PYTHON} -m verification.abrasive_report --csv {input} --json {output.json} >{output.tables}"

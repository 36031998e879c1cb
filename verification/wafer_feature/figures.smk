# A movie of each feature over the last period.
FEATURES = [(run.variant.name, f"{run.spacing:g}") for run in RUNS["wafer_feature"] if run.finest]
TARGETS += [OUT / f"movies/{name}.gif" for name, _ in FEATURES]


rule feature_movie:
    input:
        lambda wildcards: OUT / f"runs/wafer_feature/default/{wildcards.name}/{dict(FEATURES)[wildcards.name]}/run.json",
    output:
        OUT / "movies/{name,arc|cavity|sine}.gif",
    localrule: True
    shell:
        "{PYTHON} -m verification.movie $(dirname {input}) --field pressure --rate 8 --out {output}"

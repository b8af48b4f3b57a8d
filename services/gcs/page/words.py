"""What the page's own script says: ``[number, verb, argument, ...]`` as JSON, checked by the field types of the action that it asks for."""

from collections.abc import Mapping
from dataclasses import fields

import msgspec

from services.gcs.actions import areas, maps, page, plans, plots, times

WORDS: Mapping[str, type[page.PageAction]] = {
    "hello": page.Hello,
    "beat": page.Beat,
    "select": page.Select,
    "fleet-table": page.FleetTable,
    "tab": page.OpenTab,
    "theme": page.Dress,
    "shape": page.Shape,
    "view": page.ChooseView,
    "layer": page.Layer,
    "camera": page.ShowCamera,
    "topics-text": page.FilterTopics,
    "topics-scope": page.ScopeTopics,
    "service": page.ShowService,
    "topic": page.ShowTopic,
    "looks": page.Looking,
    "point": page.Point,
    "command": page.Command,
    "stop": page.StopAll,
    "release": page.ReleaseStop,
    "request-control": page.RequestControl,
    "answer-control": page.AnswerControl,
    "take-wheel": page.TakeWheel,
    "leave-wheel": page.LeaveWheel,
    "steer": page.Steer,
    "scale": page.Rescale,
    "gimbal": page.AimGimbal,
    "gimbal-mode": page.GimbalMode,
    "clock": page.RunClock,
    "rate": page.SetRate,
    "wind": page.SetWind,
    "launch": page.LaunchMission,
    "plot-topic": plots.PlotTopic,
    "plot-find": plots.PlotFind,
    "plot-add": plots.PlotAdd,
    "plot-remove": plots.PlotRemove,
    "plot-window": plots.PlotWindow,
    "plot-hold": plots.PlotHold,
    "plot-preset": plots.PlotPreset,
    "past": times.ShowPast,
    "past-at": times.ShowMoment,
    "past-event": times.StepEvent,
    "past-play": times.PlayPast,
    "past-rate": times.PlayRate,
    "live": times.ShowLive,
    "export": times.ExportMinute,
    "save-map": maps.SaveMap,
    "mapping": maps.Mapping,
    "begin-map": maps.BeginMap,
    "relocalize": maps.Relocalize,
    "plan-part": areas.PlanPart,
    "area-add": areas.AreaAdd,
    "area-move": areas.AreaMove,
    "area-drop": areas.AreaDrop,
    "area-set": areas.AreaSet,
    "area-take": areas.AreaTake,
    "area-clear": areas.AreaClear,
    "area-upload": areas.AreaUpload,
    "zone-begin": areas.ZoneBegin,
    "zone-choose": areas.ZoneChoose,
    "zone-end": areas.ZoneEnd,
    "fence-acts": areas.FenceActs,
    "survey-make": areas.SurveyMake,
    "plan-add": plans.PlanAdd,
    "plan-set": plans.PlanSet,
    "plan-move": plans.PlanMove,
    "plan-remove": plans.PlanRemove,
    "plan-shift": plans.PlanShift,
    "plan-choose": plans.PlanChoose,
    "plan-load": plans.PlanLoad,
    "plan-take": plans.PlanTake,
    "plan-clear": plans.PlanClear,
    "plan-upload": plans.PlanUpload,
    "plan-go-to": plans.PlanGoTo,
}


def action_in(word: str, page: int) -> page.PageAction | None:
    """The action that a word of this page's script asks for; None for one that is none. Which page speaks is not the word's to say."""
    try:
        said = msgspec.json.decode(word)
    except (msgspec.DecodeError, RecursionError):
        return None
    match said:
        case [int(), str(verb), *arguments] if verb in WORDS:
            kind = WORDS[verb]
        case _:
            return None
    names = [field.name for field in fields(kind)][1:]
    if len(arguments) != len(names):
        return None
    try:
        return msgspec.convert({"page": page, **dict(zip(names, arguments, strict=True))}, kind)
    except msgspec.ValidationError:
        return None

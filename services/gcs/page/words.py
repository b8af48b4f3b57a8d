"""What the page's own script says: ``[number, verb, argument, ...]`` as JSON, checked by the field types of the action that it asks for."""

from collections.abc import Mapping
from dataclasses import fields

import msgspec

from services.gcs import actions, area_actions, map_actions, planning_actions, plot_actions, time_actions

WORDS: Mapping[str, type[actions.PageAction]] = {
    "hello": actions.Hello,
    "beat": actions.Beat,
    "select": actions.Select,
    "fleet-table": actions.FleetTable,
    "tab": actions.OpenTab,
    "theme": actions.Dress,
    "shape": actions.Shape,
    "view": actions.ChooseView,
    "layer": actions.Layer,
    "camera": actions.ShowCamera,
    "topics-text": actions.FilterTopics,
    "topics-scope": actions.ScopeTopics,
    "service": actions.ShowService,
    "topic": actions.ShowTopic,
    "looks": actions.Looking,
    "point": actions.Point,
    "command": actions.Command,
    "stop": actions.StopAll,
    "release": actions.ReleaseStop,
    "request-control": actions.RequestControl,
    "answer-control": actions.AnswerControl,
    "take-wheel": actions.TakeWheel,
    "leave-wheel": actions.LeaveWheel,
    "steer": actions.Steer,
    "scale": actions.Rescale,
    "gimbal": actions.AimGimbal,
    "gimbal-mode": actions.GimbalMode,
    "clock": actions.RunClock,
    "rate": actions.SetRate,
    "wind": actions.SetWind,
    "launch": actions.LaunchMission,
    "plot-topic": plot_actions.PlotTopic,
    "plot-add": plot_actions.PlotAdd,
    "plot-remove": plot_actions.PlotRemove,
    "plot-window": plot_actions.PlotWindow,
    "plot-hold": plot_actions.PlotHold,
    "plot-preset": plot_actions.PlotPreset,
    "past": time_actions.ShowPast,
    "past-at": time_actions.ShowMoment,
    "past-event": time_actions.StepEvent,
    "past-play": time_actions.PlayPast,
    "past-rate": time_actions.PlayRate,
    "live": time_actions.ShowLive,
    "export": time_actions.ExportMinute,
    "save-map": map_actions.SaveMap,
    "mapping": map_actions.Mapping,
    "begin-map": map_actions.BeginMap,
    "relocalize": map_actions.Relocalize,
    "plan-part": area_actions.PlanPart,
    "area-add": area_actions.AreaAdd,
    "area-move": area_actions.AreaMove,
    "area-drop": area_actions.AreaDrop,
    "area-set": area_actions.AreaSet,
    "area-take": area_actions.AreaTake,
    "area-clear": area_actions.AreaClear,
    "area-upload": area_actions.AreaUpload,
    "zone-begin": area_actions.ZoneBegin,
    "zone-choose": area_actions.ZoneChoose,
    "zone-end": area_actions.ZoneEnd,
    "fence-acts": area_actions.FenceActs,
    "survey-make": area_actions.SurveyMake,
    "plan-add": planning_actions.PlanAdd,
    "plan-set": planning_actions.PlanSet,
    "plan-move": planning_actions.PlanMove,
    "plan-remove": planning_actions.PlanRemove,
    "plan-shift": planning_actions.PlanShift,
    "plan-choose": planning_actions.PlanChoose,
    "plan-load": planning_actions.PlanLoad,
    "plan-take": planning_actions.PlanTake,
    "plan-clear": planning_actions.PlanClear,
    "plan-upload": planning_actions.PlanUpload,
    "plan-go-to": planning_actions.PlanGoTo,
}


def action_in(word: str, page: int) -> actions.PageAction | None:
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
